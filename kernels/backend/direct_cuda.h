// The sums over pairs of points on a CUDA device, from the same bodies as on the host (kernels/fundamental). Built
// where the compiler nvcc is found (CMake option SHERD_CUDA); nothing here needs CUDA's headers.
#pragma once
#include <string>

#include "kernels/fundamental/pair_sums.h"

namespace sherd::fmm {

// Name of the device that sums run on; empty where there is none (or no driver).
std::string cuda_device();

// out[k][i] += what target i receives as number k; all arrays on the host. Counts are free (no padding). The order of
// additions is fixed: the same bits in every run. Throws std::runtime_error with CUDA's reason where the device fails.
// T: float or double; relative error of a pair about 1e-6 or 1e-14.
template <class T>
void cuda_pair_sum(PairSum sum, const PairSources<T>& sources, const PairTargets<T>& targets,
                   const PairConstants<T>& constants, T* const out[]);
extern template void cuda_pair_sum(PairSum, const PairSources<float>&, const PairTargets<float>&,
                                   const PairConstants<float>&, float* const[]);
extern template void cuda_pair_sum(PairSum, const PairSources<double>&, const PairTargets<double>&,
                                   const PairConstants<double>&, double* const[]);

}  // namespace sherd::fmm
