#include "engine/elastostatic/direct_assembly.h"

#include <algorithm>

#include "engine/elastostatic/row_tester.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

template <class Scalar>
void assemble_collocated(const OperatorRows& operator_rows, const Testing& testing, DenseOperator<Scalar>& out) {
  const std::size_t columns = out.size();
  parallel_for_chunks(testing.vertex_groups(), 4, [&](std::size_t begin, std::size_t end) {
    const auto workspace = operator_rows.make_workspace();
    for (std::size_t g = begin; g < end; ++g) {
      const TargetGroup targets = testing.vertex_group(g);
      const std::span<const double> blocks = operator_rows.evaluate(targets, *workspace);
      for (std::size_t k = 0; k < targets.count; ++k) {
        const std::span<Scalar> rows = out.rows(targets.vertex[k]);
        for (std::size_t v = 0; v < columns / 3; ++v)
          for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
              rows[i * columns + 3 * v + j] = static_cast<Scalar>(blocks[kLaneBlock * v + (3 * i + j) * kLanes + k]);
      }
    }
  });
}

// Adds the tested rows for columns v0 .. v0 + lanes. Each strip of columns is owned by one task.
template <class Scalar>
void add_tested(const Boundary& boundary, const Testing& testing, const RowTester& tester, const AlignedNumbers& rows,
                std::size_t v0, std::size_t lanes, DenseOperator<Scalar>& out) {
  for (std::size_t r = 0; r < tester.vertices().size(); ++r) {
    const std::uint32_t v = tester.vertices()[r];
    if (!testing.galerkin(v)) continue;
    const Real scale = 1 / boundary.vertex_area[v];
    const std::span<Scalar> row = out.rows(v);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t l = 0; l < lanes; ++l)
        for (std::size_t j = 0; j < 3; ++j)
          row[i * out.size() + 3 * (v0 + l) + j] +=
              static_cast<Scalar>(scale * rows[kLaneBlock * r + (3 * j + i) * kLanes + l]);
  }
}

template <class Scalar>
void assemble_galerkin(const Boundary& boundary, const Reconstruction& reconstruction,
                       const OperatorRows& operator_rows, const Testing& testing, DenseOperator<Scalar>& out) {
  const std::size_t stride = kLaneBlock * out.size() / 3;
  const std::size_t batch_size = std::clamp<std::size_t>((std::size_t{128} << 20) / (stride * sizeof(double)), 12, 96);
  AlignedNumbers batch(batch_size * stride);
  SourceBlockBuilder builder(boundary, reconstruction, true);
  constexpr std::size_t kStrips = 8;  // of eight columns, a task
  const std::size_t vertices = out.size() / 3, strips = (vertices + kLanes - 1) / kLanes;
  std::vector<RowTester::Work> works((strips + kStrips - 1) / kStrips);
  for (std::size_t first = 0; first < testing.gauss_groups(); first += batch_size) {
    const std::size_t groups = std::min(batch_size, testing.gauss_groups() - first);
    parallel_for_chunks(groups, 4, [&](std::size_t begin, std::size_t end) {
      const auto workspace = operator_rows.make_workspace();
      for (std::size_t g = begin; g < end; ++g)
        operator_rows.evaluate(testing.gauss_group(first + g), *workspace,
                               std::span(batch).subspan(g * stride, stride));
    });
    const RowTester tester(testing, first, groups, builder);
    parallel_for_chunks(strips, kStrips, [&](std::size_t begin, std::size_t end) {
      RowTester::Work& work = works[begin / kStrips];
      for (std::size_t strip = begin; strip < end; ++strip) {
        const std::size_t v0 = strip * kLanes, lanes = std::min(kLanes, vertices - v0);
        tester.test(batch.data(), stride, v0, lanes, work);
        add_tested(boundary, testing, tester, work.rows, v0, lanes, out);
      }
    });
  }
}

}  // namespace

template <class Scalar>
void assemble_direct(const Boundary& boundary, const Reconstruction& reconstruction, Real nu, const Testing& testing,
                     DenseOperator<Scalar>& out) {
  const OperatorRows operator_rows(boundary, reconstruction, nu);
  assemble_collocated(operator_rows, testing, out);
  assemble_galerkin(boundary, reconstruction, operator_rows, testing, out);
}

template void assemble_direct(const Boundary&, const Reconstruction&, Real, const Testing&, DenseOperator<float>&);
template void assemble_direct(const Boundary&, const Reconstruction&, Real, const Testing&, DenseOperator<double>&);

}  // namespace sherd
