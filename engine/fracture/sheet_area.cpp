#include "engine/fracture/sheet.h"

namespace sherd {
namespace {

constexpr int kMaxDepth = 5;
constexpr Real kFlatCosine = 0.8;  // a line clips well where the surface turns by less than 37 degrees

struct Corner {
  Vec3 p;
  bool inside;
};

Real triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * norm(cross(b - a, c - a));
}

// Parameters of the crossings on each edge; the number of crossings decides whether clipping by one line is right.
struct Crossings {
  std::size_t count = 0;
  Real first = 0;
  Vec3 normal;  // of the body at the first one
};

Crossings crossings(const TriangleBvh& body, const Vec3& a, const Vec3& b) {
  std::vector<TriangleBvh::Hit> hits;
  body.all_hits(a, b - a, 0, 1, hits);
  if (hits.empty()) return {};
  const auto& t = body.corners(hits.front().face);
  return {hits.size(), hits.front().t, normalized(cross(t[1] - t[0], t[2] - t[0]))};
}

void add(SheetExtent& to, const SheetExtent& part) {
  to.area += part.area, to.trace += part.trace;
}

SheetExtent extent_of(const TriangleBvh& body, const Corner& a, const Corner& b, const Corner& c, int depth) {
  const Corner corner[3] = {a, b, c};
  Crossings cross_[3];
  bool simple = true;
  int inside = 0;
  for (int k = 0; k < 3; ++k) {
    const Corner &p = corner[k], &q = corner[(k + 1) % 3];
    cross_[k] = crossings(body, p.p, q.p);
    simple &= cross_[k].count == (p.inside != q.inside ? 1u : 0u);
    inside += p.inside;
  }
  const Real whole = triangle_area(a.p, b.p, c.p);
  if (simple && inside == 0) return {};
  if (simple && inside == 3) return {whole, 0};
  if (simple && depth > 0) {
    int lone = 0;  // the corner on its own side
    while (corner[lone].inside != (inside == 1)) ++lone;
    const Crossings &out = cross_[lone], &in = cross_[(lone + 2) % 3];
    const Real part = out.first * (1 - in.first) * whole;
    const Vec3 &p = corner[lone].p, &q = corner[(lone + 1) % 3].p, &r = corner[(lone + 2) % 3].p;
    const Real chord = norm(out.first * (q - p) - (1 - in.first) * (r - p));
    const bool flat = dot(out.normal, in.normal) > kFlatCosine;
    if (flat || depth >= kMaxDepth) return {inside == 1 ? part : whole - part, chord};
  }
  if (depth >= kMaxDepth) return {body.inside((a.p + b.p + c.p) / 3.0) ? whole : 0, 0};
  const auto middle = [&](const Corner& p, const Corner& q) {
    const Vec3 m = 0.5 * (p.p + q.p);
    return Corner{m, body.inside(m)};
  };
  const Corner ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
  SheetExtent sum = extent_of(body, a, ab, ca, depth + 1);
  add(sum, extent_of(body, ab, b, bc, depth + 1));
  add(sum, extent_of(body, ca, bc, c, depth + 1));
  add(sum, extent_of(body, ab, bc, ca, depth + 1));
  return sum;
}

}  // namespace

SheetExtent extent_inside(const CrackSheet& sheet, const TriangleBvh& body) {
  std::vector<std::uint8_t> inside(sheet.state.size());
  for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = body.inside(sheet.position[v]);
  SheetExtent sum;
  for (const Triangle& n : sheet.triangles) {
    const auto corner = [&](std::size_t k) { return Corner{sheet.position[n[k]], inside[n[k]] != 0}; };
    add(sum, extent_of(body, corner(0), corner(1), corner(2), 0));
  }
  return sum;
}

}  // namespace sherd
