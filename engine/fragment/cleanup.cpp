#include "engine/fragment/cleanup.h"

#include <algorithm>

namespace sherd {
namespace {

constexpr Real kShort = 1e-3;  // of the edge length
constexpr int kRounds = 4;

std::uint32_t after(std::uint32_t e) {
  return e % 3 == 2 ? e - 2 : e + 1;
}
std::uint32_t before(std::uint32_t e) {
  return e % 3 == 0 ? e + 2 : e - 1;
}

class Cleaner {
 public:
  Cleaner(Carving& carving, Real edge_length, Real least_area)
      : carving_(carving),
        shift_(carving.body_faces()),
        short2_(kShort * edge_length * kShort * edge_length),
        least_area_(least_area) {}

  // One collapse next to the new face, its shortest edge first.
  bool collapse_at(std::uint32_t face, const std::vector<std::uint32_t>& bad) {
    const auto c = carving_.corners(shift_ + face);
    std::array<std::uint32_t, 3> order{0, 1, 2};
    const auto length2 = [&](std::uint32_t k) { return distance2(c[k], c[(k + 1) % 3]); };
    std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return length2(i) < length2(j); });
    for (const std::uint32_t k : order) {
      if (!(length2(k) < short2_)) return false;
      const std::uint32_t e = 3 * (shift_ + face) + k;
      const int from = rank(start(e)), to = rank(end(e));
      if (to > 0 && from <= to && collapse(e, bad)) return true;
      if (from > 0 && to <= from && collapse(carving_.twin(e), bad)) return true;
    }
    return false;
  }

 private:
  std::uint32_t start(std::uint32_t e) const { return carving_.triangle(e / 3)[e % 3]; }
  std::uint32_t end(std::uint32_t e) const { return start(after(e)); }
  // What may move: 0 never (a vertex of the body), then a point of one of its edges, of one of its faces, of the slab.
  int rank(std::uint32_t v) const {
    if (v < carving_.body_vertices()) return 0;
    if (v < carving_.first_crossing()) return 3;
    return 1 + static_cast<int>(carving_.crossing_operand(v));
  }
  std::vector<std::uint32_t> neighbours(std::uint32_t e) const {
    std::vector<std::uint32_t> v;
    carving_.around(e, [&](std::uint32_t i) { v.push_back(end(i)); });
    std::sort(v.begin(), v.end());
    return v;
  }
  // The collapse of an edge leaves a manifold when its ends share the two opposite vertices only, and those keep a fan.
  bool links_allow(std::uint32_t e) const {
    const std::uint32_t t = carving_.twin(e);
    const auto a = neighbours(e), b = neighbours(t);
    std::vector<std::uint32_t> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    return common.size() == 2 && neighbours(before(e)).size() > 3 && neighbours(before(t)).size() > 3;
  }

  // Moves the end of edge e, which is no vertex of the body, into its start.
  bool collapse(std::uint32_t e, const std::vector<std::uint32_t>& bad) {
    if (!links_allow(e)) return false;
    const std::uint32_t t = carving_.twin(e), keep = start(e), gone = end(e);
    std::vector<std::uint32_t> fan;
    carving_.around(t, [&](std::uint32_t i) { fan.push_back(i / 3 - shift_); });
    std::sort(fan.begin(), fan.end());
    std::vector<NewFace> old;
    for (const std::uint32_t i : fan) old.push_back(carving_.faces[i]);
    const Real volume = fan_volume6(fan);
    std::vector<std::uint32_t> changed;
    for (const std::uint32_t i : fan) {
      NewFace& f = carving_.faces[i];
      f.alive = i != e / 3 - shift_ && i != t / 3 - shift_;
      f.whole = false;
      std::replace(f.vertices.begin(), f.vertices.end(), gone, keep);
      if (f.alive) changed.push_back(i);
    }
    if (!fits(changed, fan, old, bad)) {
      for (std::size_t i = 0; i < fan.size(); ++i) carving_.faces[fan[i]] = old[i];
      return false;
    }
    carving_.kept_volume += (fan_volume6(fan) - volume) / 6;
    for (const std::uint32_t side : {e, t}) carving_.join(carving_.twin(after(side)), carving_.twin(before(side)));
    return true;
  }
  Real fan_volume6(const std::vector<std::uint32_t>& fan) const {
    Real sum = 0;
    const Vec3 origin = carving_.slab().bvh.box().centre();
    for (const std::uint32_t i : fan)
      if (carving_.faces[i].alive) sum += corner_volume6(carving_.corners(shift_ + i), origin);
    return sum;
  }
  // No good face turns over or becomes bad.
  bool fits(const std::vector<std::uint32_t>& changed, const std::vector<std::uint32_t>& fan,
            const std::vector<NewFace>& old, const std::vector<std::uint32_t>& bad) const {
    const auto was_bad = [&](std::uint32_t i) { return std::binary_search(bad.begin(), bad.end(), i); };
    const auto normal = [&](const Triangle& t) {
      const Vec3 a = carving_.position(t[0]);
      return cross(carving_.position(t[1]) - a, carving_.position(t[2]) - a);
    };
    for (const std::uint32_t i : changed) {
      const auto place = std::lower_bound(fan.begin(), fan.end(), i) - fan.begin();
      const Triangle& before_it = old[static_cast<std::size_t>(place)].vertices;
      if (!was_bad(i) && !(dot(normal(before_it), normal(carving_.faces[i].vertices)) > 0)) return false;
    }
    const BadFaces now = find_bad_faces(carving_, changed, least_area_);
    return std::all_of(now.faces.begin(), now.faces.end(), was_bad);
  }

  Carving& carving_;
  std::uint32_t shift_;
  Real short2_, least_area_;
};

}  // namespace

bool clean_up(Carving& carving, BadFaces bad, Real edge_length, Real least_area, int& collapses) {
  Cleaner cleaner(carving, edge_length, least_area);
  for (int round = 0; round < kRounds && !bad.faces.empty(); ++round) {
    bool any = false;
    for (const std::uint32_t i : bad.faces)
      while (carving.faces[i].alive && cleaner.collapse_at(i, bad.faces)) any = true, ++collapses;
    if (!any) return false;
    std::vector<std::uint32_t> parts;
    for (std::uint32_t i = 0; i < carving.faces.size(); ++i)
      if (carving.faces[i].alive && !carving.faces[i].whole) parts.push_back(i);
    bad = find_bad_faces(carving, parts, least_area);
  }
  return bad.faces.empty();
}

}  // namespace sherd
