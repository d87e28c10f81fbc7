#include "engine/fragment/piercing.h"

#include <algorithm>

#include "kernels/core/fault.h"
#include "kernels/core/predicates.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

using Corners = std::array<Vec3, 3>;
using Signs = std::array<int, 3>;

Signs sides(const Corners& t, const Corners& points) {
  return {orient3d(t[0], t[1], t[2], points[0]), orient3d(t[0], t[1], t[2], points[1]),
          orient3d(t[0], t[1], t[2], points[2])};
}
bool one_sided(const Signs& s) {
  return s[0] != 0 && s[0] == s[1] && s[1] == s[2];
}
bool has_zero(const Signs& s) {
  return s[0] == 0 || s[1] == 0 || s[2] == 0;
}

// Orientation of edge i of one triangle against edge j of the other, evaluated at most once.
class EdgeSigns {
 public:
  EdgeSigns(const Corners& a, const Corners& b) : a_(a), b_(b) {}
  int operator()(std::size_t i, std::size_t j) {
    int& s = sign_[3 * i + j];
    if (s == kUnknown) s = orient3d(a_[i], a_[(i + 1) % 3], b_[j], b_[(j + 1) % 3]);
    return s;
  }

 private:
  static constexpr int kUnknown = 2;
  const Corners &a_, &b_;
  std::array<int, 9> sign_{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
};

enum class Pass { kNo, kYes, kZero };

// A line passes a triangle when its three edges turn the same way around it.
Pass passes(const Signs& s) {
  const int low = std::min({s[0], s[1], s[2]}), high = std::max({s[0], s[1], s[2]});
  if (low < 0 && high > 0) return Pass::kNo;
  return has_zero(s) ? Pass::kZero : Pass::kYes;
}

struct PairPoint {
  Crossing crossing;
  bool start;
};

class PairTest {
 public:
  PairTest(const CutOperand& body, const CutOperand& slab) : body_(body), slab_(slab) {}

  // Crossings of the edges of fa with fb and the other way round: none, or one start and one end.
  PierceStatus run(std::uint32_t fa, std::uint32_t fb, std::vector<PairPoint>& found) {
    found.clear();
    const Corners &a = body_.bvh.corners(fa), &b = slab_.bvh.corners(fb);
    const Signs sb = sides(a, b);
    if (one_sided(sb)) return PierceStatus::kOk;
    const Signs sa = sides(b, a);
    if (one_sided(sa)) return PierceStatus::kOk;
    if (has_zero(sa) || has_zero(sb)) return PierceStatus::kCoincidence;
    EdgeSigns sign(a, b);
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (sa[i] == sa[(i + 1) % 3]) continue;
      const Pass pass = passes({sign(i, 0), sign(i, 1), sign(i, 2)});
      if (pass == Pass::kZero) return PierceStatus::kCoincidence;
      if (pass == Pass::kYes) found.push_back({{0, body_.edge_id(3 * fa + i), fb}, sa[i] < 0});
    }
    for (std::uint32_t j = 0; j < 3; ++j) {
      if (sb[j] == sb[(j + 1) % 3]) continue;
      const Pass pass = passes({sign(0, j), sign(1, j), sign(2, j)});
      if (pass == Pass::kZero) return PierceStatus::kCoincidence;
      if (pass == Pass::kYes) found.push_back({{1, slab_.edge_id(3 * fb + j), fa}, sb[j] > 0});
    }
    const bool good = found.empty() || (found.size() == 2 && found[0].start != found[1].start);
    return good ? PierceStatus::kOk : PierceStatus::kInconsistent;
  }

 private:
  const CutOperand &body_, &slab_;
};

ArrangementPoint point_of(const Crossing& c, const CutOperand& body, const CutOperand& slab) {
  const CutOperand &edges = c.edge_operand == 0 ? body : slab, &faces = c.edge_operand == 0 ? slab : body;
  const Corners& t = edges.bvh.corners(c.edge / 3);
  return make_crossing(t[c.edge % 3], t[(c.edge % 3 + 1) % 3], faces.bvh.corners(c.face));
}

bool loops_close(const Piercing& p) {
  std::vector<int> starts(p.points.size(), 0), ends(p.points.size(), 0);
  for (const CrossSegment& s : p.segments) ++starts[s.start], ++ends[s.end];
  return std::all_of(starts.begin(), starts.end(), [](int n) { return n == 1; }) &&
         std::all_of(ends.begin(), ends.end(), [](int n) { return n == 1; });
}

Piercing failed(PierceStatus status, std::string reason) {
  Piercing p;
  p.status = status, p.reason = std::move(reason);
  return p;
}

}  // namespace

Piercing pierce(const CutOperand& body, const CutOperand& slab) {
  fault_point("cut.pierce");
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  body.bvh.overlapping_pairs(slab.bvh, pairs);
  Piercing result;
  struct Raw {
    std::array<std::uint32_t, 2> face;
    Crossing start, end;
  };
  std::vector<Raw> raw;
  std::vector<PairPoint> found;
  PairTest test(body, slab);
  for (const auto& [fa, fb] : pairs) {
    const PierceStatus status = test.run(fa, fb, found);
    if (status == PierceStatus::kCoincidence)
      return failed(status, "the slab touches the body in an exact coincidence");
    if (status == PierceStatus::kInconsistent) return failed(status, "two faces cross in an impossible way");
    if (found.empty()) continue;
    const std::size_t s = found[0].start ? 0 : 1;
    raw.push_back({{fa, fb}, found[s].crossing, found[1 - s].crossing});
    result.crossings.push_back(found[0].crossing), result.crossings.push_back(found[1].crossing);
  }
  auto& crossings = result.crossings;
  std::sort(crossings.begin(), crossings.end());
  crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
  const auto id = [&](const Crossing& c) {
    return static_cast<std::uint32_t>(std::lower_bound(crossings.begin(), crossings.end(), c) - crossings.begin());
  };
  for (const Crossing& c : crossings) result.points.push_back(point_of(c, body, slab));
  for (const Raw& r : raw) result.segments.push_back({r.face, id(r.start), id(r.end)});
  if (!loops_close(result)) return failed(PierceStatus::kInconsistent, "the cut does not close to loops");
  return result;
}

bool inside_exact(const CutOperand& operand, const Vec3& p, bool& decided) {
  const Box box = operand.bvh.box();
  const Real size = box.diagonal() + distance(p, box.centre());
  decided = true;
  if (!box.overlaps({p, p})) return false;
  Random random(0x5EED);
  std::vector<std::uint32_t> near;
  for (int attempt = 0; attempt < 8; ++attempt) {
    // Nearly along x: the segment's box stays thin. Leaves the bounding box for certain.
    const Vec3 q = p + size * Vec3{2, 0.02 * random.uniform(-1, 1), 0.02 * random.uniform(-1, 1)};
    Box segment;
    segment.grow(p), segment.grow(q);
    operand.bvh.overlapping(segment, near);
    bool zero = false;
    int count = 0;
    for (std::uint32_t f : near) {
      const Corners& t = operand.bvh.corners(f);
      const int sp = orient3d(t[0], t[1], t[2], p), sq = orient3d(t[0], t[1], t[2], q);
      if (sp == sq && sp != 0) continue;
      const Pass pass = passes({orient3d(p, q, t[0], t[1]), orient3d(p, q, t[1], t[2]), orient3d(p, q, t[2], t[0])});
      if (pass == Pass::kNo) continue;
      if (sp == 0 || sq == 0 || pass == Pass::kZero) zero = true;
      ++count;
    }
    if (!zero) return count % 2 == 1;
  }
  decided = false;
  return false;
}

}  // namespace sherd
