#include "engine/elastostatic/direct_assembly.h"

#include <algorithm>
#include <map>

#include "kernels/core/parallel.h"

namespace sherd {
namespace {

template <class Scalar>
void assemble_collocated(const OperatorRows& operator_rows, const Testing& testing, DenseOperator<Scalar>& out) {
  const std::size_t columns = out.size();
  parallel_for_chunks(testing.vertex_groups(), 4, [&](std::size_t begin, std::size_t end) {
    const auto workspace = operator_rows.make_workspace();
    std::vector<Real> rows(3 * kLanes * columns);
    for (std::size_t i = begin; i < end; ++i) {
      const TargetGroup g = testing.group(i);
      operator_rows.evaluate(g, *workspace, rows);
      for (std::size_t k = 0; k < g.count; ++k)
        std::transform(rows.begin() + static_cast<std::ptrdiff_t>(3 * k * columns),
                       rows.begin() + static_cast<std::ptrdiff_t>(3 * (k + 1) * columns), out.rows(g.vertex[k]).begin(),
                       [](Real v) { return static_cast<Scalar>(v); });
    }
  });
}

// A panel of the batch that reaches a vertex: its place in the batch and its weights.
struct Reach {
  std::size_t slot;
  const Testing::Weight* weight;
};

// Rows of a vertex += sum over panels and points of weight * rows at the point.
template <class Scalar>
void add_tested(const std::vector<Reach>& reach, const std::vector<Real>& batch, std::size_t columns,
                std::span<Scalar> out) {
  constexpr std::size_t kRows = 3 * Testing::kPoints;
  std::vector<const double*> panels;
  std::vector<Real> weights, sum(3 * columns);
  for (const Reach& r : reach) {
    panels.push_back(batch.data() + r.slot * kRows * columns);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < Testing::kPoints; ++k)
        for (std::size_t j = 0; j < 3; ++j) weights.push_back(r.weight->block[k].m[i][j]);
  }
  lane_kernels().add_rows(panels.data(), weights.data(), panels.size(), kRows, columns, columns, sum.data());
  for (std::size_t i = 0; i < sum.size(); ++i) out[i] += static_cast<Scalar>(sum[i]);
}

template <class Scalar>
void assemble_galerkin(const OperatorRows& operator_rows, const Testing& testing, DenseOperator<Scalar>& out) {
  const std::size_t columns = out.size(), panel_bytes = 3 * Testing::kPoints * columns * sizeof(Real);
  const std::size_t batch_size = std::clamp<std::size_t>((std::size_t{128} << 20) / panel_bytes, 16, 256);
  const std::vector<std::uint32_t>& panels = testing.panels();
  std::vector<Real> batch(batch_size * 3 * Testing::kPoints * columns);
  for (std::size_t first = 0; first < panels.size(); first += batch_size) {
    const std::size_t count = std::min(batch_size, panels.size() - first);
    std::vector<std::vector<Testing::Weight>> weights(count);
    parallel_for_chunks(count, 8, [&](std::size_t begin, std::size_t end) {
      const auto workspace = operator_rows.make_workspace();
      std::vector<Real> rows(3 * kLanes * columns);
      for (std::size_t i = begin; i < end; ++i) {
        operator_rows.evaluate(testing.group(testing.vertex_groups() + first + i), *workspace, rows);
        std::copy_n(rows.begin(), 3 * Testing::kPoints * columns,
                    batch.begin() + static_cast<std::ptrdiff_t>(i * 3 * Testing::kPoints * columns));
        weights[i] = testing.weights(panels[first + i]);
      }
    });
    std::map<std::uint32_t, std::vector<Reach>> reach;
    for (std::size_t i = 0; i < count; ++i)
      for (const Testing::Weight& w : weights[i]) reach[w.vertex].push_back({i, &w});
    const std::vector<std::pair<std::uint32_t, std::vector<Reach>>> rows(reach.begin(), reach.end());
    parallel_for(rows.size(), 1,
                 [&](std::size_t i) { add_tested(rows[i].second, batch, columns, out.rows(rows[i].first)); });
  }
}

}  // namespace

template <class Scalar>
void assemble_direct(const OperatorRows& operator_rows, const Testing& testing, DenseOperator<Scalar>& out) {
  assemble_collocated(operator_rows, testing, out);
  if (!testing.panels().empty()) assemble_galerkin(operator_rows, testing, out);
}

template void assemble_direct(const OperatorRows&, const Testing&, DenseOperator<float>&);
template void assemble_direct(const OperatorRows&, const Testing&, DenseOperator<double>&);

}  // namespace sherd
