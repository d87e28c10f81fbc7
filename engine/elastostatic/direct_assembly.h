// The direct formulation's matrix with reconstructed displacements, contracted to vertex-by-vertex blocks: testing
// times operator times reconstruction.
#pragma once
#include "engine/elastostatic/dense_operator.h"
#include "engine/elastostatic/testing.h"

namespace sherd {

// Fills `out` (zeros, one point a vertex). Parallel; the same bits for any number of threads. Takes up to 64 MiB
// besides.
template <class Scalar>
void assemble_direct(const Boundary& boundary, const Reconstruction& reconstruction, Real nu, const Testing& testing,
                     DenseOperator<Scalar>& out);

}  // namespace sherd
