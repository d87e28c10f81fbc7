#include "engine/elastostatic/deflation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "kernels/core/parallel.h"

namespace sherd {
namespace {

using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr std::size_t kGrain = 256;

// Grid nodes with a vertex in their support, and each vertex's eight (node, hat value).
struct CellGrid {
  struct Hat {
    std::size_t node;
    Real value;
  };
  std::vector<Vec3> nodes;
  std::vector<std::vector<Hat>> hats;  // per vertex
  Real spacing = 1;
};

CellGrid make_grid(const SurfaceMesh& mesh, int cells) {
  const Box box = bounding_box(mesh);
  const Vec3 extent = box.high - box.low;
  CellGrid grid;
  grid.spacing = std::max({extent.x, extent.y, extent.z}) / cells;
  grid.hats.resize(mesh.vertex_count());
  // Cells are centred on the box, so that a plate thinner than a cell lies between two layers of nodes only if it must:
  // a side shorter than half a cell gets one layer.
  std::map<std::array<int, 3>, std::size_t> index;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    int low[3];
    Real part[3];
    for (int k = 0; k < 3; ++k) {
      const Real side = extent[k] / grid.spacing;
      const Real x = side < 0.5 ? 0 : (mesh.vertices[v][k] - box.low[k]) / grid.spacing;
      low[k] = static_cast<int>(std::floor(x)), part[k] = x - low[k];
    }
    for (int corner = 0; corner < 8; ++corner) {
      Real value = 1;
      std::array<int, 3> id{};
      for (int k = 0; k < 3; ++k) {
        const bool up = (corner >> k) & 1;
        value *= up ? part[k] : 1 - part[k];
        id[static_cast<std::size_t>(k)] = low[k] + (up ? 1 : 0);
      }
      if (value <= 0) continue;
      const auto [it, fresh] = index.try_emplace(id, grid.nodes.size());
      if (fresh) grid.nodes.push_back(box.low + Vec3{id[0] * grid.spacing, id[1] * grid.spacing, id[2] * grid.spacing});
      grid.hats[v].push_back({it->second, value});
    }
  }
  return grid;
}

}  // namespace

struct Deflation::Impl {
  explicit Impl(const std::vector<Mat3>& blocks) : inverse_blocks(blocks) {}

  const std::vector<Mat3>& inverse_blocks;
  Matrix z, bz;              // 3 nv x k, row major: a row is read at once
  std::vector<Real> weight;  // per vertex, lumped area over total
  Eigen::FullPivLU<Eigen::MatrixXd> coarse;

  // sum over rows of weight * matrix row * x row, in fixed chunks.
  Eigen::VectorXd project(std::span<const Real> x) const {
    const auto k = z.cols();
    std::vector<Eigen::VectorXd> partial((x.size() + kGrain - 1) / kGrain);
    parallel_for_chunks(x.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(k);
      for (std::size_t i = begin; i < end; ++i)
        sum += z.row(static_cast<Eigen::Index>(i)).transpose() * (weight[i / 3] * x[i]);
      partial[begin / kGrain] = std::move(sum);
    });
    Eigen::VectorXd total = Eigen::VectorXd::Zero(k);
    for (const Eigen::VectorXd& p : partial) total += p;
    return total;
  }
};

Deflation::Deflation(const LinearOperator& b, const Boundary& boundary, const std::vector<Mat3>& inverse_blocks,
                     const DeflationOptions& options)
    : impl_(std::make_unique<Impl>(inverse_blocks)) {
  const SurfaceMesh& mesh = boundary.mesh;
  CellGrid grid;
  for (int cells = options.cells; cells >= 1; --cells) {
    grid = make_grid(mesh, cells);
    if (6 * grid.nodes.size() <= std::min(options.max_dimension, 3 * mesh.vertex_count() / 10)) break;
  }
  const std::size_t rows = 3 * mesh.vertex_count(), k = 6 * grid.nodes.size();
  Matrix& z = impl_->z;
  z = Matrix::Zero(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(k));
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    impl_->weight.push_back(boundary.vertex_area[v] / boundary.area);
    for (const CellGrid::Hat& h : grid.hats[v])
      for (int mode = 0; mode < 6; ++mode) {
        Vec3 axis{};
        axis[mode % 3] = 1;
        const Vec3 motion =
            (mode < 3 ? axis : cross(axis, mesh.vertices[v] - grid.nodes[h.node]) / grid.spacing) * h.value;
        for (int c = 0; c < 3; ++c)
          z(static_cast<Eigen::Index>(3 * v) + c, static_cast<Eigen::Index>(6 * h.node) + mode) = motion[c];
      }
  }
  impl_->bz = Matrix(z.rows(), z.cols());
  b.apply_block({z.data(), rows * k}, k, {impl_->bz.data(), rows * k});
  Eigen::MatrixXd coarse(k, k);
  // Column by column, each a projection of a column of B Z: the same bits for any number of threads.
  std::vector<Real> column(rows);
  for (std::size_t j = 0; j < k; ++j) {
    for (std::size_t i = 0; i < rows; ++i)
      column[i] = impl_->bz(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    coarse.col(static_cast<Eigen::Index>(j)) = impl_->project(column);
  }
  // Motions of a node with few vertices are nearly dependent: a rank-revealing factorisation leaves those out.
  impl_->coarse.setThreshold(1e-9);
  impl_->coarse.compute(coarse);
}

Deflation::~Deflation() = default;
std::size_t Deflation::dimension() const {
  return static_cast<std::size_t>(impl_->z.cols());
}

void Deflation::apply(std::span<const Real> r, std::span<Real> out) const {
  const Eigen::VectorXd c = impl_->coarse.solve(impl_->project(r));
  parallel_for(r.size() / 3, kGrain, [&](std::size_t p) {
    Vec3 rest, coarse;
    for (int k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>(3 * p) + k;
      rest[k] = r[static_cast<std::size_t>(row)] - impl_->bz.row(row).dot(c);
      coarse[k] = impl_->z.row(row).dot(c);
    }
    const Vec3 fine = impl_->inverse_blocks[p] * rest + coarse;
    for (std::size_t k = 0; k < 3; ++k) out[3 * p + k] = fine[static_cast<int>(k)];
  });
}

}  // namespace sherd
