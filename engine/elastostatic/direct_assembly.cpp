#include "engine/elastostatic/direct_assembly.h"

#include <algorithm>

#include "engine/elastostatic/source_block.h"
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

// The transposed reconstruction once more, now from the left: eight vertices (24 columns) at a time in the lanes, block
// entry [j][i][lane]: column component j, test component i. Each strip of columns is owned by one task.
template <class Scalar>
class Tester {
 public:
  Tester(const Boundary& boundary, const Testing& testing, DenseOperator<Scalar>& out)
      : boundary_(boundary), testing_(testing), out_(out) {}

  // Adds the points of the groups from `first` on to their rows; `batch`: the groups' lane blocks one after another.
  void add(const SourceBlock& block, const std::vector<std::size_t>& slot_of_panel, std::size_t first,
           std::size_t groups, const std::vector<double>& batch) {
    const std::size_t vertices = out_.size() / 3, stride = kLaneBlock * vertices;
    std::vector<Real> weights;  // ten a point
    std::vector<std::size_t> slot;
    const std::vector<Testing::Point>& points = testing_.gauss_points();
    for (std::size_t i = first * kLanes; i < std::min((first + groups) * kLanes, points.size()); ++i) {
      slot.push_back(slot_of_panel[points[i].panel]);
      for (std::size_t a = 0; a < cubic::kNodes; ++a)
        weights.push_back(points[i].weight * cubic::evaluate(cubic::kShape[a], points[i].s, points[i].t));
    }
    const LaneKernels& kernels = lane_kernels();
    parallel_for_chunks((vertices + kLanes - 1) / kLanes, 8, [&](std::size_t begin, std::size_t end) {
      std::vector<double> nodes, corners(2 * kLaneBlock * block.corners.size()), rows;
      for (std::size_t strip = begin; strip < end; ++strip) {
        nodes.assign(kLaneBlock * block.nodes.size(), 0), rows.assign(kLaneBlock * block.vertices.size(), 0);
        const std::size_t v0 = strip * kLanes, lanes = std::min(kLanes, vertices - v0);
        for (std::size_t p = 0; p < slot.size(); ++p) {
          const double* in = batch.data() + p / kLanes * stride + kLaneBlock * v0 + p % kLanes;
          double value[kLaneBlock] = {};
          for (std::size_t l = 0; l < lanes; ++l)
            for (std::size_t i = 0; i < 3; ++i)
              for (std::size_t j = 0; j < 3; ++j)
                value[(3 * j + i) * kLanes + l] = in[kLaneBlock * l + (3 * i + j) * kLanes];
          kernels.add_weighted(value, weights.data() + cubic::kNodes * p, block.local[slot[p]].data(), nodes.data());
        }
        kernels.gather(block.gather(), nodes.data(), corners.data(), rows.data());
        store(block, rows, v0, lanes);
      }
    });
  }

 private:
  void store(const SourceBlock& block, const std::vector<double>& rows, std::size_t v0, std::size_t lanes) {
    for (std::size_t r = 0; r < block.vertices.size(); ++r) {
      const std::uint32_t v = block.vertices[r];
      if (!testing_.galerkin(v)) continue;
      const Real scale = 1 / boundary_.vertex_area[v];
      const std::span<Scalar> out = out_.rows(v);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t l = 0; l < lanes; ++l)
          for (std::size_t j = 0; j < 3; ++j)
            out[i * out_.size() + 3 * (v0 + l) + j] +=
                static_cast<Scalar>(scale * rows[kLaneBlock * r + (3 * j + i) * kLanes + l]);
    }
  }

  const Boundary& boundary_;
  const Testing& testing_;
  DenseOperator<Scalar>& out_;
};

template <class Scalar>
void assemble_galerkin(const Boundary& boundary, const Reconstruction& reconstruction,
                       const OperatorRows& operator_rows, const Testing& testing, DenseOperator<Scalar>& out) {
  const std::size_t stride = kLaneBlock * out.size() / 3;
  const std::size_t batch_size = std::clamp<std::size_t>((std::size_t{128} << 20) / (stride * sizeof(double)), 12, 96);
  std::vector<double> batch(batch_size * stride);
  SourceBlockBuilder builder(boundary, reconstruction, true);
  std::vector<std::size_t> slot_of_panel(boundary.panels.size(), 0);
  Tester<Scalar> tester(boundary, testing, out);
  for (std::size_t first = 0; first < testing.gauss_groups(); first += batch_size) {
    const std::size_t groups = std::min(batch_size, testing.gauss_groups() - first);
    parallel_for_chunks(groups, 4, [&](std::size_t begin, std::size_t end) {
      const auto workspace = operator_rows.make_workspace();
      for (std::size_t g = begin; g < end; ++g) {
        const std::span<const double> blocks = operator_rows.evaluate(testing.gauss_group(first + g), *workspace);
        std::copy(blocks.begin(), blocks.end(), batch.begin() + static_cast<std::ptrdiff_t>(g * stride));
      }
    });
    std::vector<std::uint32_t> panels;  // of the batch; the points are in their order
    const auto& points = testing.gauss_points();
    for (std::size_t i = first * kLanes; i < std::min((first + groups) * kLanes, points.size()); ++i)
      if (panels.empty() || panels.back() != points[i].panel) {
        slot_of_panel[points[i].panel] = panels.size();
        panels.push_back(points[i].panel);
      }
    tester.add(builder.build(panels), slot_of_panel, first, groups, batch);
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
