// The functions of one processor, in the order of PairSum. Plain arrays: nothing that the linker could mix.
#pragma once
#include "kernels/fmm/pairs.h"

namespace sherd::fmm {

template <class T>
struct PairTable {
  PairFunction<T> function[kPairSums];
};
struct PairTables {
  PairTable<float> single;
  PairTable<double> twice;
};

}  // namespace sherd::fmm
