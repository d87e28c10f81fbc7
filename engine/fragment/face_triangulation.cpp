#include "engine/fragment/face_triangulation.h"

#include <algorithm>
#include <deque>

namespace sherd {
namespace {

constexpr std::uint32_t kNobody = 0xFFFFFFFFu;

// edge k runs from v[k] to v[(k+1)%3]; next[k] lies across it.
struct Cell {
  std::array<std::uint32_t, 3> v, next;
  std::array<bool, 3> fixed{};
};

class Triangulator {
 public:
  explicit Triangulator(const FaceArrangement& face)
      : face_(face),
        orient_({face.points[0].position, face.points[1].position, face.points[2].position}, face.points, face.edges) {}

  FaceTriangulation run() {
    if (orient_.degenerate()) return fail("a cut face has no area");
    cells_.push_back({{0, 1, 2}, {kNobody, kNobody, kNobody}, {}});
    for (std::uint32_t p = 3; p < face_.points.size(); ++p)
      if (!insert(p)) return fail("two points of the cut coincide in a face");
    for (const auto& s : face_.segments)
      if (!enforce(s[0], s[1])) return fail("a segment of the cut passes a point of the cut");
    refine();
    return sides();
  }

 private:
  static FaceTriangulation fail(const char* reason) {
    FaceTriangulation t;
    t.reason = reason;
    return t;
  }
  static std::uint32_t up(std::uint32_t k) { return k == 2 ? 0 : k + 1; }
  static std::uint32_t down(std::uint32_t k) { return k == 0 ? 2 : k - 1; }
  const Vec3& at(std::uint32_t p) const { return face_.points[p].position; }

  void relink(std::uint32_t cell, std::uint32_t from, std::uint32_t to) {
    if (cell == kNobody) return;
    for (std::uint32_t& n : cells_[cell].next)
      if (n == from) {
        n = to;
        return;
      }
  }
  // The edge of `cell` with `neighbour` across it; they are neighbours.
  std::uint32_t edge_to(std::uint32_t cell, std::uint32_t neighbour) const {
    const auto& next = cells_[cell].next;
    return next[0] == neighbour ? 0 : (next[1] == neighbour ? 1 : 2);
  }

  // Walks towards p; at most every cell once, then all in turn (a walk may circle where diagonals are not Delaunay).
  bool locate(std::uint32_t p, std::uint32_t& cell, std::array<int, 3>& sign) {
    cell = static_cast<std::uint32_t>(cells_.size()) - 1;
    for (std::size_t step = 0; step < cells_.size(); ++step) {
      const std::uint32_t out = side_signs(cell, p, sign);
      if (out == kNobody) return true;
      if (cells_[cell].next[out] == kNobody) break;
      cell = cells_[cell].next[out];
    }
    for (cell = 0; cell < cells_.size(); ++cell)
      if (side_signs(cell, p, sign) == kNobody) return true;
    return false;
  }
  // Some edge of the cell with p strictly beyond it, or kNobody.
  std::uint32_t side_signs(std::uint32_t cell, std::uint32_t p, std::array<int, 3>& sign) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      sign[k] = orient_(cells_[cell].v[k], cells_[cell].v[up(k)], p);
      if (sign[k] < 0) return k;
    }
    return kNobody;
  }

  bool insert(std::uint32_t p) {
    std::uint32_t cell;
    std::array<int, 3> sign;
    if (!locate(p, cell, sign)) return false;
    const auto zeros = std::count(sign.begin(), sign.end(), 0);
    if (zeros > 1) return false;
    if (zeros == 0) {
      split_cell(cell, p);
    } else {
      split_edge(cell, static_cast<std::uint32_t>(std::find(sign.begin(), sign.end(), 0) - sign.begin()), p);
    }
    return true;
  }

  void split_cell(std::uint32_t c, std::uint32_t p) {
    const Cell old = cells_[c];
    const auto d = static_cast<std::uint32_t>(cells_.size()), e = d + 1;
    cells_.resize(cells_.size() + 2);
    cells_[c] = {{old.v[0], old.v[1], p}, {old.next[0], d, e}, {}};
    cells_[d] = {{old.v[1], old.v[2], p}, {old.next[1], e, c}, {}};
    cells_[e] = {{old.v[2], old.v[0], p}, {old.next[2], c, d}, {}};
    relink(old.next[1], c, d), relink(old.next[2], c, e);
    legalize({c, d, e});
  }

  // p lies inside edge k of cell c: (a, b, o) becomes (a, p, o) and (p, b, o), and so does the cell across.
  void split_edge(std::uint32_t c, std::uint32_t k, std::uint32_t p) {
    const std::uint32_t other = cells_[c].next[k];
    const std::uint32_t c2 = halve(c, k, p);
    if (other == kNobody) {
      legalize({c, c2});
      return;
    }
    const std::uint32_t j = edge_to(other, c);
    const std::uint32_t other2 = halve(other, j, p);
    // c keeps (a, p), and across it lies (p, a), the second half of the other; c2 = (p, b) faces the first half (b, p).
    cells_[c].next[0] = other2, cells_[other2].next[0] = c;
    cells_[c2].next[0] = other, cells_[other].next[0] = c2;
    legalize({c, c2, other, other2});
  }
  // Afterwards cell c is (a, p, o) with the split edge first and the new cell, returned, is (p, b, o).
  std::uint32_t halve(std::uint32_t c, std::uint32_t k, std::uint32_t p) {
    const Cell old = cells_[c];
    const std::uint32_t a = old.v[k], b = old.v[up(k)], o = old.v[down(k)];
    const auto d = static_cast<std::uint32_t>(cells_.size());
    cells_.push_back({{p, b, o}, {kNobody, old.next[up(k)], c}, {}});
    cells_[c] = {{a, p, o}, {kNobody, d, old.next[down(k)]}, {}};
    relink(old.next[up(k)], c, d);
    return d;
  }

  // The quadrilateral around edge k of c: a, b on the edge, o opposite in c, q opposite in the neighbour.
  struct Quad {
    std::uint32_t c, d, k, j, a, b, o, q;
  };
  Quad quad(std::uint32_t c, std::uint32_t k) const {
    const std::uint32_t d = cells_[c].next[k], j = edge_to(d, c);
    return {c, d, k, j, cells_[c].v[k], cells_[c].v[up(k)], cells_[c].v[down(k)], cells_[d].v[down(j)]};
  }
  bool convex(const Quad& s) { return orient_(s.o, s.a, s.q) > 0 && orient_(s.q, s.b, s.o) > 0; }
  // The angles opposite to the edge add up to more than a half turn, in the face's own plane.
  bool wants_flip(const Quad& s) const {
    const Vec3 oa = at(s.a) - at(s.o), ob = at(s.b) - at(s.o), qa = at(s.a) - at(s.q), qb = at(s.b) - at(s.q);
    const Real so = norm(cross(oa, ob)), co = dot(oa, ob), sq = norm(cross(qa, qb)), cq = dot(qa, qb);
    const Real scale = norm(oa) * norm(ob) * norm(qa) * norm(qb);
    return so * cq + co * sq < -1e-10 * scale;
  }
  // c becomes (o, a, q), d becomes (q, b, o); the new edge q -> o is edge 2 of both.
  void flip(const Quad& s) {
    const Cell c = cells_[s.c], d = cells_[s.d];
    const std::uint32_t oa = down(s.k), bo = up(s.k), aq = up(s.j), qb = down(s.j);
    cells_[s.c] = {{s.o, s.a, s.q}, {c.next[oa], d.next[aq], s.d}, {c.fixed[oa], d.fixed[aq], false}};
    cells_[s.d] = {{s.q, s.b, s.o}, {d.next[qb], c.next[bo], s.c}, {d.fixed[qb], c.fixed[bo], false}};
    relink(d.next[aq], s.d, s.c), relink(c.next[bo], s.c, s.d);
  }

  void legalize(std::vector<std::uint32_t> work) {
    // Each flip is progress up to rounding; the bound ends a circle that rounding might cause.
    std::size_t budget = 64 + 16 * cells_.size();
    while (!work.empty()) {
      const std::uint32_t c = work.back();
      work.pop_back();
      for (std::uint32_t k = 0; k < 3; ++k) {
        if (cells_[c].next[k] == kNobody || cells_[c].fixed[k]) continue;
        const Quad s = quad(c, k);
        if (!wants_flip(s) || !convex(s)) continue;
        if (budget-- == 0) return;
        flip(s);
        work.push_back(s.c), work.push_back(s.d);
        break;
      }
    }
  }
  void refine() {
    std::vector<std::uint32_t> all(cells_.size());
    for (std::uint32_t c = 0; c < all.size(); ++c) all[c] = c;
    legalize(std::move(all));
  }

  bool find_edge(std::uint32_t a, std::uint32_t b, std::uint32_t& c, std::uint32_t& k) const {
    for (c = 0; c < cells_.size(); ++c)
      for (k = 0; k < 3; ++k)
        if (cells_[c].v[k] == a && cells_[c].v[up(k)] == b) return true;
    return false;
  }
  bool fix(std::uint32_t a, std::uint32_t b) {
    std::uint32_t c, k;
    bool found = false;
    if (find_edge(a, b, c, k)) cells_[c].fixed[k] = found = true;
    if (find_edge(b, a, c, k)) cells_[c].fixed[k] = found = true;
    return found;
  }

  // The edges that the segment a -> b crosses, as vertex pairs (right of the segment, left of it).
  bool crossed_edges(std::uint32_t a, std::uint32_t b, std::deque<std::array<std::uint32_t, 2>>& crossed) {
    std::uint32_t c = 0, k = 0;
    bool found = false;
    for (c = 0; c < cells_.size() && !found; ++c)
      for (k = 0; k < 3 && !found; ++k) {
        if (cells_[c].v[k] != a) continue;
        const std::uint32_t p = cells_[c].v[up(k)], q = cells_[c].v[down(k)];
        if (p == b || q == b) return false;
        found = orient_(a, b, p) < 0 && orient_(a, b, q) > 0 && orient_(p, q, b) < 0;
        if (found) {
          k = up(k);
          break;
        }
      }
    if (!found) return false;
    --c;
    for (std::size_t step = 0; step <= cells_.size(); ++step) {
      if (cells_[c].next[k] == kNobody || cells_[c].fixed[k]) return false;
      const Quad s = quad(c, k);
      crossed.push_back({s.a, s.b});
      if (s.q == b) return true;
      const int side = orient_(a, b, s.q);
      if (side == 0) return false;
      // In the neighbour (b, a, q): leave through a q when q lies left, through q b when right.
      c = s.d, k = side > 0 ? up(s.j) : down(s.j);
    }
    return false;
  }

  // Sloan: flip crossed edges until none is left.
  bool enforce(std::uint32_t a, std::uint32_t b) {
    if (fix(a, b)) return true;
    std::deque<std::array<std::uint32_t, 2>> crossed;
    if (!crossed_edges(a, b, crossed)) return false;
    std::size_t budget = 64 + 16 * crossed.size() * crossed.size();
    while (!crossed.empty()) {
      if (budget-- == 0) return false;
      const auto edge = crossed.front();
      crossed.pop_front();
      std::uint32_t c, k;
      if (!find_edge(edge[0], edge[1], c, k) && !find_edge(edge[1], edge[0], c, k)) return false;
      const Quad s = quad(c, k);
      if (!convex(s)) {
        crossed.push_back(edge);
        continue;
      }
      flip(s);
      if (s.o == a || s.o == b || s.q == a || s.q == b) continue;
      if (orient_(a, b, s.o) * orient_(a, b, s.q) < 0) crossed.push_back({s.o, s.q});
    }
    return fix(a, b);
  }

  FaceTriangulation sides() {
    constexpr char kUnknown = 2;
    FaceTriangulation result;
    result.right.assign(cells_.size(), kUnknown);
    std::vector<std::uint32_t> stack;
    const auto label = [&](std::uint32_t c, char right) {
      if (result.right[c] == kUnknown) result.right[c] = right, stack.push_back(c);
      return result.right[c] == right;
    };
    bool consistent = true;
    for (const auto& s : face_.segments) {
      std::uint32_t c, k;
      if (find_edge(s[0], s[1], c, k)) consistent = label(c, 0) && consistent;
      if (find_edge(s[1], s[0], c, k)) consistent = label(c, 1) && consistent;
    }
    while (!stack.empty()) {
      const std::uint32_t c = stack.back();
      stack.pop_back();
      for (std::uint32_t k = 0; k < 3; ++k)
        if (cells_[c].next[k] != kNobody && !cells_[c].fixed[k])
          consistent = label(cells_[c].next[k], result.right[c]) && consistent;
    }
    if (!consistent || std::count(result.right.begin(), result.right.end(), kUnknown) > 0)
      return fail("the sides of the cut contradict each other in a face");
    for (const Cell& c : cells_) result.triangles.push_back(c.v);
    result.ok = true;
    return result;
  }

  const FaceArrangement& face_;
  PlanarOrientation orient_;
  std::vector<Cell> cells_;
};

}  // namespace

FaceTriangulation triangulate_face(const FaceArrangement& face) {
  return Triangulator(face).run();
}

}  // namespace sherd
