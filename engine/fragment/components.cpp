#include "engine/fragment/components.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "engine/mesh/validate_edges.h"

namespace sherd {
namespace {

// Walks from the cut over whole body faces, all sides of it in turn and one shell of the body after the other, until
// at most one side of each shell is left open: that one has the rest of the shell.
class Walk {
 public:
  explicit Walk(const Carving& carving) : carving_(carving), groups_(carving.faces.size()) {
    const std::uint32_t n = 3 * carving.body_faces();
    std::vector<Seed> seeds;
    for (std::uint32_t i = 0; i < carving.faces.size(); ++i) {
      if (!carving.faces[i].alive) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t t = carving.twin(n + 3 * i + k);
        if (t >= n) {
          groups_.join(i, (t - n) / 3);
        } else {
          seeds.push_back({carving.body().shell_of(t / 3), t / 3, i});
        }
      }
    }
    std::sort(seeds.begin(), seeds.end());
    walked_.resize(carving.faces.size());
    rest_.assign(carving.body().shells().size(), kNone);
    for (std::size_t i = 0, j = 0; i < seeds.size(); i = j) {
      while (j < seeds.size() && seeds[j].shell == seeds[i].shell) ++j;
      walk(seeds[i].shell,
           {seeds.begin() + static_cast<std::ptrdiff_t>(i), seeds.begin() + static_cast<std::ptrdiff_t>(j)});
    }
  }

  std::uint32_t group(std::uint32_t part) { return groups_.find(part); }
  // Faces walked over, by any member of their group.
  const std::vector<std::uint32_t>& walked(std::uint32_t part) const { return walked_[part]; }
  // Any member of the group that has the rest of a body shell; kNone for a shell without whole faces at the cut.
  std::uint32_t rest(std::uint32_t shell) const { return rest_[shell]; }
  // Any member of the group that has a body face the walk came over, or SparseMap::kAbsent.
  std::uint32_t owner(std::uint32_t face) const { return owner_[face]; }

 private:
  struct Seed {
    std::uint32_t shell, face, part;
    friend auto operator<=>(const Seed&, const Seed&) = default;
  };
  struct Front {
    std::uint32_t group;
    std::vector<std::uint32_t> open, done;
  };

  Front& front_of(std::vector<Front>& fronts, std::uint32_t part) {
    const std::uint32_t g = groups_.find(part);
    return *std::find_if(fronts.begin(), fronts.end(), [&](const Front& f) { return f.group == g; });
  }
  void unite(std::vector<Front>& fronts, std::uint32_t a, std::uint32_t b) {
    if (groups_.find(a) == groups_.find(b)) return;
    Front *p = &front_of(fronts, a), *q = &front_of(fronts, b);
    groups_.join(a, b);
    if (p->open.size() + p->done.size() < q->open.size() + q->done.size()) std::swap(p, q);
    p->group = groups_.find(a);
    p->open.insert(p->open.end(), q->open.begin(), q->open.end());
    p->done.insert(p->done.end(), q->done.begin(), q->done.end());
    fronts.erase(fronts.begin() + (q - fronts.data()));
  }
  // Takes a face into a group's front; meeting another group's face unites the two.
  void take(std::vector<Front>& fronts, std::uint32_t part, std::uint32_t face) {
    if (owner_.insert(face, part)) {
      front_of(fronts, part).open.push_back(face);
    } else {
      unite(fronts, part, owner_[face]);
    }
  }

  void walk(std::uint32_t shell, const std::vector<Seed>& seeds) {
    std::vector<Front> fronts;
    for (const Seed& s : seeds) {
      const std::uint32_t g = groups_.find(s.part);
      if (std::none_of(fronts.begin(), fronts.end(), [&](const Front& f) { return f.group == g; }))
        fronts.push_back({g, {}, {}});
    }
    if (fronts.size() > 1) {
      for (const Seed& s : seeds) take(fronts, s.part, s.face);
      expand(fronts);
    }
    rest_[shell] = fronts[0].group;
    for (Front& f : fronts)
      if (!f.open.empty()) rest_[shell] = f.group;
    for (Front& f : fronts) {
      if (f.group == rest_[shell]) continue;
      auto& all = walked_[f.group];
      all.insert(all.end(), f.done.begin(), f.done.end());
    }
  }
  void expand(std::vector<Front>& fronts) {
    const auto open = [&] {
      return std::count_if(fronts.begin(), fronts.end(), [](const Front& f) { return !f.open.empty(); });
    };
    for (std::size_t turn = 0; open() > 1; ++turn) {
      const std::size_t i = turn % fronts.size();
      if (fronts[i].open.empty()) continue;
      const std::uint32_t face = fronts[i].open.back(), part = fronts[i].group;
      fronts[i].open.pop_back(), fronts[i].done.push_back(face);
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t next = carving_.twin(3 * face + k) / 3;
        if (next < carving_.body_faces()) take(fronts, part, next);
      }
    }
  }

  const Carving& carving_;
  DisjointSets groups_;  // of new faces
  SparseMap owner_;
  std::vector<std::vector<std::uint32_t>> walked_;
  std::vector<std::uint32_t> rest_;
};

class Builder {
 public:
  Builder(const Carving& carving, Components& out)
      : carving_(carving), out_(out), walk_(carving), origin_(carving.slab().bvh.box().centre()) {}

  void run() {
    collect_groups();
    collect_rests();
    collect_solids();
    out_.euler = euler();
    const auto genus2 = 2 * static_cast<std::int64_t>(out_.shells.size()) - out_.euler;
    if (genus2 < 0 || genus2 % 2 != 0) out_.reason = "the cut surface has an impossible number of handles";
  }

 private:
  std::uint32_t shell_of_part(std::uint32_t part) { return number_[walk_.group(part)]; }

  void collect_groups() {
    const std::uint32_t n = carving_.body_faces();
    number_.assign(carving_.faces.size(), kNone);
    std::vector<Real> volume6;
    for (std::uint32_t i = 0; i < carving_.faces.size(); ++i) {
      if (!carving_.faces[i].alive) continue;
      std::uint32_t& shell = number_[walk_.group(i)];
      if (shell == kNone) {
        shell = static_cast<std::uint32_t>(out_.shells.size());
        out_.shells.emplace_back(), volume6.push_back(0);
      }
      out_.shells[shell].parts.push_back(i);
      volume6[shell] += corner_volume6(carving_.corners(n + i), origin_);
    }
    for (std::uint32_t i = 0; i < carving_.faces.size(); ++i) {
      if (walk_.walked(i).empty()) continue;
      auto& whole = out_.shells[shell_of_part(i)].whole;
      whole.insert(whole.end(), walk_.walked(i).begin(), walk_.walked(i).end());
    }
    for (std::size_t s = 0; s < out_.shells.size(); ++s) {
      CutShell& shell = out_.shells[s];
      std::sort(shell.whole.begin(), shell.whole.end());
      for (const std::uint32_t f : shell.whole) volume6[s] += corner_volume6(carving_.corners(f), origin_);
      shell.volume = volume6[s] / 6, shell.faces = shell.parts.size() + shell.whole.size();
    }
  }

  // What is left of each shell of the body: what was there less what is accounted for.
  void collect_rests() {
    const auto& body = carving_.body();
    std::vector<BodyShell> left = body.shells();
    const auto subtract = [&](const std::vector<std::uint32_t>& faces) {
      for (const std::uint32_t f : faces) {
        BodyShell& shell = left[body.shell_of(f)];
        --shell.faces, shell.volume -= corner_volume6(body.operand().corners(f), origin_) / 6;
      }
    };
    subtract(carving_.cut), subtract(carving_.dropped);
    std::vector<char> touched(left.size(), 0);
    for (const std::uint32_t f : carving_.cut) touched[body.shell_of(f)] = 1;
    for (const CutShell& shell : out_.shells) subtract(shell.whole);
    for (std::uint32_t s = 0; s < left.size(); ++s) {
      if (left[s].faces == 0) continue;
      std::uint32_t owner = static_cast<std::uint32_t>(out_.shells.size());
      if (touched[s]) {
        owner = shell_of_part(walk_.rest(s));
      } else {
        out_.shells.emplace_back();
      }
      out_.shells[owner].rest.push_back(s);
      out_.shells[owner].faces += left[s].faces, out_.shells[owner].volume += left[s].volume;
      rest_owner_.resize(left.size(), kNone), rest_owner_[s] = owner;
    }
    rest_owner_.resize(left.size(), kNone);
  }

  void collect_solids() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t s = 0; s < out_.shells.size(); ++s)
      if (out_.shells[s].volume > 0) order.push_back(s);
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return out_.shells[a].volume > out_.shells[b].volume; });
    std::vector<CutSolid> solids(out_.shells.size());
    for (const std::uint32_t s : order) solids[s] = {{s}, out_.shells[s].faces, out_.shells[s].volume};
    for (std::uint32_t c = 0; c < out_.shells.size(); ++c) {
      if (out_.shells[c].volume > 0) continue;
      const std::vector<char> around = shells_around(c);
      const auto solid = std::find_if(order.rbegin(), order.rend(), [&](std::uint32_t s) { return around[s]; });
      if (solid == order.rend()) continue;  // a sliver
      solids[*solid].shells.push_back(c);
      solids[*solid].faces += out_.shells[c].faces, solids[*solid].volume += out_.shells[c].volume;
    }
    for (const std::uint32_t s : order) out_.solids.push_back(std::move(solids[s]));
    std::stable_sort(out_.solids.begin(), out_.solids.end(),
                     [](const CutSolid& a, const CutSolid& b) { return a.volume > b.volume; });
  }

  // Which shells have a point of shell c inside: majority of three watertight parities, all shells in one go.
  std::vector<char> shells_around(std::uint32_t c) {
    if (!parts_tree_) {
      SurfaceMesh soup;
      for (std::uint32_t i = 0; i < carving_.faces.size(); ++i) {
        if (!carving_.faces[i].alive) continue;
        const auto n = static_cast<std::uint32_t>(soup.vertex_count());
        for (const Vec3& p : carving_.corners(carving_.body_faces() + i)) soup.vertices.push_back(p);
        soup.triangles.push_back({n, n + 1, n + 2}), part_.push_back(i);
      }
      parts_tree_ = std::make_unique<TriangleBvh>(soup);
    }
    const CutShell& own = out_.shells[c];
    const std::uint32_t face =
        own.parts.empty() ? carving_.body().shells()[own.rest[0]].face : carving_.body_faces() + own.parts[0];
    const Vec3 p = carving_.corners(face)[0];
    std::vector<char> votes(out_.shells.size(), 0);
    std::vector<TriangleBvh::Hit> hits;
    for (const Vec3& d :
         {Vec3{0.5377, 0.1834, 0.8234}, Vec3{-0.7273, 0.6343, 0.2621}, Vec3{0.2192, -0.9413, -0.2570}}) {
      std::vector<char> odd(out_.shells.size(), 0);
      carving_.body().bvh().all_hits(p, d, 0, std::numeric_limits<Real>::infinity(), hits);
      for (const auto& h : hits)
        if (carving_.alive(h.face)) odd[shell_of_face(h.face)] ^= 1;
      parts_tree_->all_hits(p, d, 0, std::numeric_limits<Real>::infinity(), hits);
      for (const auto& h : hits) odd[shell_of_part(part_[h.face])] ^= 1;
      for (std::size_t s = 0; s < odd.size(); ++s) votes[s] = static_cast<char>(votes[s] + odd[s]);
    }
    for (char& v : votes) v = v >= 2;
    votes[c] = 0;
    return votes;
  }
  std::uint32_t shell_of_face(std::uint32_t face) {
    const std::uint32_t owner = walk_.owner(face);
    return owner == SparseMap::kAbsent ? rest_owner_[carving_.body().shell_of(face)] : shell_of_part(owner);
  }

  // Corners of faces that go are lost unless a face that stays has them.
  std::int64_t euler() const {
    const auto& body = carving_.body();
    SparseMap used, seen;
    std::int64_t vertices = 0, lost = 0, faces = body.mesh().triangle_count();
    for (const NewFace& f : carving_.faces) {
      if (!f.alive) continue;
      ++faces;
      for (const std::uint32_t v : f.vertices)
        if (used.insert(v, 1) && v >= carving_.body_vertices()) ++vertices;
    }
    for (const auto* list : {&carving_.cut, &carving_.dropped})
      for (const std::uint32_t f : *list) {
        --faces;
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::uint32_t v = body.mesh().triangles[f][k];
          if (used.contains(v) || !seen.insert(v, 1)) continue;
          bool stays = false;
          std::uint32_t e = 3 * f + k;
          do {
            stays = stays || carving_.alive(e / 3);
            e = body.twins()[e % 3 == 0 ? e + 2 : e - 1];
          } while (e != 3 * f + k);
          lost += !stays;
        }
      }
    const std::int64_t before = body.euler() + static_cast<std::int64_t>(body.mesh().triangle_count() / 2);
    return before - lost + vertices - faces / 2;
  }

  const Carving& carving_;
  Components& out_;
  Walk walk_;
  Vec3 origin_;
  std::vector<std::uint32_t> number_;      // shell of a group
  std::vector<std::uint32_t> rest_owner_;  // shell that has the rest of a body shell
  std::unique_ptr<TriangleBvh> parts_tree_;
  std::vector<std::uint32_t> part_;
};

}  // namespace

Components find_components(const Carving& carving) {
  Components out;
  Builder(carving, out).run();
  return out;
}

}  // namespace sherd
