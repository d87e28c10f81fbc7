#include "engine/elastostatic/near_field.h"

#include <algorithm>

#include "engine/elastostatic/panel_rows.h"
#include "engine/elastostatic/panel_search.h"
#include "engine/elastostatic/row_tester.h"
#include "kernels/core/parallel.h"

namespace sherd {

namespace {

std::vector<Real> near_reach(const Boundary& b) {
  std::vector<Real> out(b.panels.size());
  for (std::size_t t = 0; t < out.size(); ++t)
    out[t] = std::max(b.near2[t], NearField::kReach * NearField::kReach * b.panels[t].longest2);
  return out;
}

}  // namespace

// Everything that rows at any target need.
struct NearField::Source {
  const Boundary& boundary;
  const Reconstruction& reconstruction;
  const Testing& testing;
  LaneConstants constants, negative;
  std::vector<Real> reach2;  // of a panel, m^2
  PanelSearch search;
  std::vector<SourceBlock> blocks;  // of the search, vertices numbered locally

  Source(const Boundary& b, const Reconstruction& r, Real nu, const Testing& t)
      : boundary(b),
        reconstruction(r),
        testing(t),
        constants(lane_constants(nu)),
        reach2(near_reach(b)),
        search(b.centroid, reach2) {
    negative = {-constants.one, -constants.two, -constants.angle};
    blocks.resize(search.block_count());
    parallel_for_chunks(blocks.size(), 256, [&](std::size_t begin, std::size_t end) {
      SourceBlockBuilder builder(b, r, true);
      for (std::size_t i = begin; i < end; ++i) blocks[i] = builder.build(search.block(i));
    });
  }
};

// Rows at eight targets: a lane block for every vertex touched. One a thread.
class NearField::Rows {
 public:
  explicit Rows(const Source& source)
      : source_(source), slot_(source.reconstruction.vertex_count(), kNone), kernels_(lane_kernels()) {}

  // Afterwards vertices() and values() hold the difference, total() its double layer of 1; `diagonal` (when given)
  // takes the exact block of each target that is a vertex.
  void evaluate(const TargetGroup& g, std::vector<Mat3>* diagonal) {
    for (const std::uint32_t v : vertices_) slot_[v] = kNone;
    vertices_.clear(), values_.clear();
    std::fill_n(total_, kLanes, 0);
    Box box;
    for (std::size_t k = 0; k < kLanes; ++k) {
      const Vec3 x = g.x[k < g.count ? k : 0];
      box.grow(x);
      for (int i = 0; i < 3; ++i) x_[static_cast<std::size_t>(i) * kLanes + k] = x[i];
    }
    source_.search.visit(box, [&](std::size_t b) { add_block(b, g, diagonal); });
  }
  const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  const std::vector<double>& values() const { return values_; }
  const double* total() const { return total_; }

 private:
  void add_block(std::size_t index, const TargetGroup& g, std::vector<Mat3>* diagonal) {
    const Boundary& b = source_.boundary;
    const SourceBlock& block = source_.blocks[index];
    near_.clear();
    for (std::size_t i = 0; i < block.panels.size(); ++i) {
      const std::uint32_t t = block.panels[i];
      Real nearest = 1e300;
      for (std::size_t k = 0; k < g.count; ++k) nearest = std::min(nearest, distance2(g.x[k], b.centroid[t]));
      if (nearest <= source_.reach2[t]) near_.push_back({i, nearest <= b.near2[t]});
    }
    if (near_.empty()) return;
    const LaneTables& tables = lane_tables();
    freedom_.assign(kLaneBlock * block.freedoms, 0);
    for (const auto& [i, closed] : near_) {
      const std::uint32_t* local = block.local[i].data();
      if (closed)
        add_near_panel(b, g, block.panels[i], block.lane_panels[i], local, source_.constants, kernels_, freedom_.data(),
                       total_);
      else
        kernels_.six_points(block.lane_panels[i], tables, source_.constants, x_, nullptr, local, freedom_.data(),
                            total_);
    }
    gather(block);
    if (diagonal)
      for (std::size_t v = 0; v < block.vertices.size(); ++v)
        for (std::size_t k = 0; k < g.count; ++k)
          if (block.vertices[v] == g.vertex[k])
            for (int i = 0; i < 3; ++i)
              for (int j = 0; j < 3; ++j)
                (*diagonal)[g.vertex[k]][i][j] += vertex_[kLaneBlock * v + (3 * i + j) * kLanes + k];
    freedom_.assign(kLaneBlock * block.freedoms, 0);
    for (const auto& [i, closed] : near_)
      kernels_.three_points(block.lane_panels[i], tables, source_.negative, x_, block.local[i].data(), freedom_.data(),
                            total_);
    gather(block);
  }

  // Adds the block's freedoms to the vertices they stand for; leaves them in vertex_, too.
  void gather(const SourceBlock& block) {
    vertex_.assign(kLaneBlock * block.vertices.size(), 0);
    kernels_.gather(block.gather(), freedom_.data(), vertex_.data());
    for (std::size_t v = 0; v < block.vertices.size(); ++v) {
      std::uint32_t& slot = slot_[block.vertices[v]];
      if (slot == kNone) {
        slot = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(block.vertices[v]), values_.resize(values_.size() + kLaneBlock, 0);
      }
      double* to = values_.data() + kLaneBlock * slot;
      for (std::size_t i = 0; i < kLaneBlock; ++i) to[i] += vertex_[kLaneBlock * v + i];
    }
  }

  const Source& source_;
  std::vector<std::uint32_t> slot_, vertices_;
  std::vector<double> values_;
  AlignedNumbers freedom_, vertex_;
  std::vector<std::pair<std::size_t, bool>> near_;
  double x_[3 * kLanes], total_[kLanes];
  const LaneKernels& kernels_;
};

// Blocks map displacement to displacement, so they compare with 1; what a block of panels touches but no near panel
// does is zero.
constexpr float kNegligible = 1e-9f;

bool negligible(const float* block) {
  for (std::size_t i = 0; i < 9; ++i)
    if (std::abs(block[i]) > kNegligible) return false;
  return true;
}

// Part of a tested row.
struct NearField::Entry {
  std::uint32_t row, column;
  float block[9];
};

NearField::NearField(const Boundary& b, const Reconstruction& r, Real nu, const Testing& testing)
    : total_(testing.collocated().size() + testing.gauss_points().size(), 0), diagonal_(r.vertex_count()) {
  const Source source(b, r, nu, testing);
  add_collocated(source);
  add_tested(source);
}

// Rows of collocated vertices; of the others the diagonal only.
void NearField::add_collocated(const Source& source) {
  const Testing& testing = source.testing;
  const std::vector<std::uint32_t> order = along_curve(source.boundary.mesh.vertices);
  std::vector<std::uint32_t> place(order.size(), kNone);  // among the collocated vertices
  for (std::uint32_t i = 0; i < testing.collocated().size(); ++i) place[testing.collocated()[i]] = i;
  const std::size_t groups = (order.size() + kLanes - 1) / kLanes;
  constexpr std::size_t kGroupsPerPiece = 64;
  pieces_.resize((groups + kGroupsPerPiece - 1) / kGroupsPerPiece);
  parallel_for(pieces_.size(), 1, [&](std::size_t p) {
    Piece& piece = pieces_[p];
    Rows rows(source);
    for (std::size_t group = p * kGroupsPerPiece; group < std::min((p + 1) * kGroupsPerPiece, groups); ++group) {
      TargetGroup g;
      g.count = std::min(kLanes, order.size() - group * kLanes);
      for (std::size_t k = 0; k < g.count; ++k) {
        g.vertex[k] = order[group * kLanes + k], g.panel[k] = kNone;
        g.x[k] = source.boundary.mesh.vertices[g.vertex[k]];
      }
      rows.evaluate(g, &diagonal_);
      for (std::size_t k = 0; k < g.count; ++k) {
        if (place[g.vertex[k]] == kNone) continue;
        total_[place[g.vertex[k]]] = rows.total()[k];
        piece.row.push_back(g.vertex[k]);
        for (std::size_t v = 0; v < rows.vertices().size(); ++v) {
          float block[9];
          for (std::size_t e = 0; e < 9; ++e)
            block[e] = static_cast<float>(rows.values()[kLaneBlock * v + e * kLanes + k]);
          if (negligible(block)) continue;
          piece.column.push_back(rows.vertices()[v]), piece.block.insert(piece.block.end(), block, block + 9);
        }
        piece.begin.push_back(piece.column.size());
      }
    }
    piece.column.shrink_to_fit(), piece.block.shrink_to_fit();
  });
}

void NearField::add_tested(const Source& source) {
  const Testing& testing = source.testing;
  if (testing.gauss_groups() == 0) return;
  constexpr std::size_t kGroups = 24;  // the points of 32 panels
  std::vector<std::vector<Entry>> batches((testing.gauss_groups() + kGroups - 1) / kGroups);
  const std::size_t collocated = testing.collocated().size();
  parallel_for(batches.size(), 1, [&](std::size_t batch) {
    const std::size_t first = batch * kGroups, groups = std::min(kGroups, testing.gauss_groups() - first);
    SourceBlockBuilder builder(source.boundary, source.reconstruction, true);
    const RowTester tester(testing, first, groups, builder);
    Rows rows(source);
    std::vector<std::uint32_t> slot(source.reconstruction.vertex_count(), kNone), columns;
    std::vector<std::vector<double>> group_values(groups);
    std::vector<std::vector<std::uint32_t>> group_vertices(groups);
    for (std::size_t i = 0; i < groups; ++i) {
      const TargetGroup g = testing.gauss_group(first + i);
      rows.evaluate(g, nullptr);
      for (std::size_t k = 0; k < g.count; ++k) total_[collocated + (first + i) * kLanes + k] = rows.total()[k];
      group_values[i] = rows.values(), group_vertices[i] = rows.vertices();
      for (const std::uint32_t v : rows.vertices())
        if (slot[v] == kNone) slot[v] = static_cast<std::uint32_t>(columns.size()), columns.push_back(v);
    }
    const std::size_t stride = kLaneBlock * columns.size();
    std::vector<double> values(groups * stride, 0);
    for (std::size_t i = 0; i < groups; ++i)
      for (std::size_t v = 0; v < group_vertices[i].size(); ++v)
        std::copy_n(group_values[i].data() + kLaneBlock * v, kLaneBlock,
                    values.data() + i * stride + kLaneBlock * slot[group_vertices[i][v]]);
    RowTester::Work work;
    for (std::size_t v0 = 0; v0 < columns.size(); v0 += kLanes) {
      const std::size_t lanes = std::min(kLanes, columns.size() - v0);
      tester.test(values.data(), stride, v0, lanes, work);
      for (std::size_t r = 0; r < tester.vertices().size(); ++r) {
        const std::uint32_t row = tester.vertices()[r];
        if (!testing.galerkin(row)) continue;
        const Real scale = 1 / source.boundary.vertex_area[row];
        for (std::size_t l = 0; l < lanes; ++l) {
          Entry e{row, columns[v0 + l], {}};
          for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
              e.block[3 * i + j] = static_cast<float>(scale * work.rows[kLaneBlock * r + (3 * j + i) * kLanes + l]);
          if (!negligible(e.block)) batches[batch].push_back(e);
        }
      }
    }
  });
  merge(batches);
}

// Rows from the parts that batches of panels gave, in the order of the batches.
void NearField::merge(std::vector<std::vector<Entry>>& batches) {
  std::vector<std::size_t> begin(diagonal_.size() + 1, 0);
  for (const auto& batch : batches)
    for (const Entry& e : batch) ++begin[e.row + 1];
  for (std::size_t v = 0; v < diagonal_.size(); ++v) begin[v + 1] += begin[v];
  std::vector<Entry> sorted(begin.back());
  std::vector<std::size_t> next = begin;
  for (auto& batch : batches) {
    for (const Entry& e : batch) sorted[next[e.row]++] = e;
    std::vector<Entry>().swap(batch);
  }
  constexpr std::size_t kRowsPerPiece = 512;
  const std::size_t first = pieces_.size();
  pieces_.resize(first + (diagonal_.size() + kRowsPerPiece - 1) / kRowsPerPiece);
  parallel_for(pieces_.size() - first, 1, [&](std::size_t p) {
    Piece& piece = pieces_[first + p];
    for (std::size_t v = p * kRowsPerPiece; v < std::min((p + 1) * kRowsPerPiece, diagonal_.size()); ++v) {
      if (begin[v] == begin[v + 1]) continue;
      std::stable_sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin[v]),
                       sorted.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]),
                       [](const Entry& a, const Entry& b) { return a.column < b.column; });
      for (std::size_t i = begin[v]; i < begin[v + 1]; ++i) {
        const Entry& e = sorted[i];
        if (i > begin[v] && sorted[i - 1].column == e.column) {
          for (std::size_t k = 0; k < 9; ++k) piece.block[piece.block.size() - 9 + k] += e.block[k];
          continue;
        }
        piece.column.push_back(e.column), piece.block.insert(piece.block.end(), e.block, e.block + 9);
      }
      piece.row.push_back(static_cast<std::uint32_t>(v)), piece.begin.push_back(piece.column.size());
    }
  });
}

void NearField::add(std::span<const Real> x, std::span<Real> y) const {
  parallel_for(pieces_.size(), 1, [&](std::size_t p) {
    const Piece& piece = pieces_[p];
    for (std::size_t r = 0; r < piece.row.size(); ++r) {
      Real sum[3] = {};
      for (std::size_t e = piece.begin[r]; e < piece.begin[r + 1]; ++e) {
        const float* b = piece.block.data() + 9 * e;
        const Real* v = x.data() + 3 * piece.column[e];
        for (int i = 0; i < 3; ++i)
          sum[i] += static_cast<Real>(b[3 * i]) * v[0] + static_cast<Real>(b[3 * i + 1]) * v[1] +
                    static_cast<Real>(b[3 * i + 2]) * v[2];
      }
      for (std::size_t i = 0; i < 3; ++i) y[3 * piece.row[r] + i] += sum[i];
    }
  });
}

std::size_t NearField::bytes() const {
  std::size_t sum = total_.size() * sizeof(Real) + diagonal_.size() * sizeof(Mat3);
  for (const Piece& p : pieces_)
    sum += p.column.size() * sizeof(std::uint32_t) + p.block.size() * sizeof(float) + p.row.size() * 12;
  return sum;
}

}  // namespace sherd
