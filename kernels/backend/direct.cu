// One thread a target; a block's threads pack a tile of sources together into shared memory, then walk through it.
#include <cuda_runtime.h>

#include <stdexcept>
#include <vector>

#include "kernels/backend/direct_cuda.h"
#include "kernels/fundamental/pair_bodies.h"

namespace sherd::fmm {
namespace {

constexpr unsigned kTile = 128;  // threads of a block, and sources of a tile

void check(cudaError_t status, const char* what) {
  if (status != cudaSuccess) throw std::runtime_error(std::string("CUDA: ") + what + ": " + cudaGetErrorString(status));
}

__device__ inline float inverse_root(float a) {
  return a > least_square<float>() ? rsqrtf(a) : 0.0f;
}
__device__ inline double inverse_root(double a) {
  return a > least_square<double>() ? rsqrt(a) : 0.0;
}

template <class T>
struct ThreadLanes {
  using Number = T;
  using Vector = T;
};

// A column of the tile: rows at fixed distances.
template <class T>
struct TileColumn {
  const T* at;
  __device__ T operator[](int k) const { return at[static_cast<unsigned>(k) * kTile]; }
};

// Arrays on the device, passed by value.
template <class T>
struct DeviceArrays {
  unsigned sources, targets;
  const T *y[3], *strength[kMaxStrengths], *x[3], *normal[3];
  T* out[kMaxOutputs];
};

template <PairSum S, class T>
__global__ void __launch_bounds__(kTile) sum_kernel(DeviceArrays<T> a, PairConstants<T> constants) {
  using Body = PairBody<S, ThreadLanes<T>>;
  constexpr PairShape shape = pair_shape(S);
  __shared__ T tile[(3 + Body::kPacked) * kTile];
  const unsigned i = blockIdx.x * kTile + threadIdx.x, target = i < a.targets ? i : a.targets - 1;
  const T x[3] = {a.x[0][target], a.x[1][target], a.x[2][target]};
  T acc[Body::kAccumulators];
  for (int k = 0; k < Body::kAccumulators; ++k) acc[k] = T(0);
  for (unsigned first = 0; first < a.sources; first += kTile) {
    const unsigned count = a.sources - first < kTile ? a.sources - first : kTile;
    if (threadIdx.x < count) {
      const unsigned j = first + threadIdx.x;
      T strength[shape.strengths], packed[Body::kPacked];
      for (std::size_t k = 0; k < shape.strengths; ++k) strength[k] = a.strength[k][j];
      Body::pack(constants, strength, packed);
      for (unsigned k = 0; k < 3; ++k) tile[k * kTile + threadIdx.x] = a.y[k][j];
      for (unsigned k = 0; k < Body::kPacked; ++k) tile[(3 + k) * kTile + threadIdx.x] = packed[k];
    }
    __syncthreads();
    for (unsigned j = 0; j < count; ++j) {
      const TileColumn<T> y{tile + j}, p{tile + 3 * kTile + j};
      const T r[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
      Body::add(constants, r, inverse_root(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]), p, acc);
    }
    __syncthreads();
  }
  T normal[3]{}, result[shape.outputs];
  if constexpr (shape.target_normals)
    for (int k = 0; k < 3; ++k) normal[k] = a.normal[k][target];
  Body::finish(constants, acc, normal, result);
  if (i < a.targets)
    for (std::size_t k = 0; k < shape.outputs; ++k) a.out[k][i] += result[k];
}

// Columns on the device, freed at the end.
template <class T>
class DeviceColumns {
 public:
  DeviceColumns() = default;
  DeviceColumns(const DeviceColumns&) = delete;
  DeviceColumns& operator=(const DeviceColumns&) = delete;
  ~DeviceColumns() {
    for (T* p : columns_) cudaFree(p);
  }
  T* copy(const T* host, std::size_t count) {
    T* device = nullptr;
    check(cudaMalloc(&device, count * sizeof(T)), "memory for a column");
    columns_.push_back(device);
    check(cudaMemcpy(device, host, count * sizeof(T), cudaMemcpyHostToDevice), "copy to the device");
    return device;
  }

 private:
  std::vector<T*> columns_;
};

template <PairSum S, class T>
void run(const PairSources<T>& sources, const PairTargets<T>& targets, const PairConstants<T>& constants,
         T* const out[]) {
  constexpr PairShape shape = pair_shape(S);
  DeviceColumns<T> columns;
  DeviceArrays<T> a{};
  a.sources = static_cast<unsigned>(sources.count), a.targets = static_cast<unsigned>(targets.count);
  for (std::size_t k = 0; k < 3; ++k) {
    a.y[k] = columns.copy(sources.x[k], sources.count);
    a.x[k] = columns.copy(targets.x[k], targets.count);
    if (shape.target_normals) a.normal[k] = columns.copy(targets.normal[k], targets.count);
  }
  for (std::size_t k = 0; k < shape.strengths; ++k) a.strength[k] = columns.copy(sources.strength[k], sources.count);
  for (std::size_t k = 0; k < shape.outputs; ++k) a.out[k] = columns.copy(out[k], targets.count);
  sum_kernel<S, T><<<(a.targets + kTile - 1) / kTile, kTile>>>(a, constants);
  check(cudaGetLastError(), "launch");
  for (std::size_t k = 0; k < shape.outputs; ++k)
    check(cudaMemcpy(out[k], a.out[k], targets.count * sizeof(T), cudaMemcpyDeviceToHost), "sum over pairs");
}

}  // namespace

std::string cuda_device() {
  int count = 0;
  cudaDeviceProp properties{};
  if (cudaGetDeviceCount(&count) != cudaSuccess || count == 0) return {};
  return cudaGetDeviceProperties(&properties, 0) == cudaSuccess ? properties.name : "";
}

template <class T>
void cuda_pair_sum(PairSum sum, const PairSources<T>& s, const PairTargets<T>& t, const PairConstants<T>& c,
                   T* const out[]) {
  if (s.count == 0 || t.count == 0) return;
  if (s.count > 0x7FFFFFFFu || t.count > 0x7FFFFFFFu)
    throw std::runtime_error("CUDA: more than 2^31 points in one sum");
  switch (sum) {
    case PairSum::kLaplaceValue:
      return run<PairSum::kLaplaceValue>(s, t, c, out);
    case PairSum::kLaplaceGradient:
      return run<PairSum::kLaplaceGradient>(s, t, c, out);
    case PairSum::kDipoleValue:
      return run<PairSum::kDipoleValue>(s, t, c, out);
    case PairSum::kDipoleGradient:
      return run<PairSum::kDipoleGradient>(s, t, c, out);
    case PairSum::kKelvinValue:
      return run<PairSum::kKelvinValue>(s, t, c, out);
    case PairSum::kKelvinGradient:
      return run<PairSum::kKelvinGradient>(s, t, c, out);
    case PairSum::kKelvinStress:
      return run<PairSum::kKelvinStress>(s, t, c, out);
    case PairSum::kKelvinTraction:
      return run<PairSum::kKelvinTraction>(s, t, c, out);
    case PairSum::kElasticValue:
      return run<PairSum::kElasticValue>(s, t, c, out);
    case PairSum::kElasticGradient:
      return run<PairSum::kElasticGradient>(s, t, c, out);
  }
}
template void cuda_pair_sum(PairSum, const PairSources<float>&, const PairTargets<float>&, const PairConstants<float>&,
                            float* const[]);
template void cuda_pair_sum(PairSum, const PairSources<double>&, const PairTargets<double>&,
                            const PairConstants<double>&, double* const[]);

}  // namespace sherd::fmm
