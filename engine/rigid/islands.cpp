#include "engine/rigid/islands.h"

#include <algorithm>
#include <numeric>

namespace sherd {
namespace {

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

std::vector<Island> islands(std::span<const Motion> motions, std::span<const ContactRow> rows) {
  std::vector<std::uint32_t> parent(motions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto moves = [&](std::uint32_t i) { return motions[i].inverse_mass > 0; };
  for (const ContactRow& r : rows) {
    if (!moves(r.a) || !moves(r.b)) continue;
    const std::uint32_t a = find_root(parent, r.a), b = find_root(parent, r.b);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::uint32_t> number(motions.size(), 0xFFFFFFFFu);
  std::vector<Island> found;
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    const ContactRow& r = rows[i];
    if (!moves(r.a) && !moves(r.b)) continue;
    const std::uint32_t root = find_root(parent, moves(r.a) ? r.a : r.b);
    if (number[root] == 0xFFFFFFFFu) number[root] = static_cast<std::uint32_t>(found.size()), found.emplace_back();
    Island& island = found[number[root]];
    island.rows.push_back(i);
    island.anchored = island.anchored || !moves(r.a) || !moves(r.b);
  }
  for (std::uint32_t m = 0; m < motions.size(); ++m)
    if (const std::uint32_t n = number[find_root(parent, m)]; n != 0xFFFFFFFFu) found[n].motions.push_back(m);
  return found;
}

IslandProblem isolate(const Island& island, std::span<const Motion> motions, std::span<const ContactRow> rows) {
  IslandProblem p;
  for (const std::uint32_t m : island.motions) p.motions.push_back(motions[m]);
  const auto still = static_cast<std::uint32_t>(p.motions.size());
  p.motions.emplace_back();
  const auto local = [&](std::uint32_t m) {
    const auto at = std::lower_bound(island.motions.begin(), island.motions.end(), m);
    return at != island.motions.end() && *at == m ? static_cast<std::uint32_t>(at - island.motions.begin()) : still;
  };
  for (const std::uint32_t i : island.rows) {
    p.rows.push_back(rows[i]);
    p.rows.back().a = local(rows[i].a), p.rows.back().b = local(rows[i].b);
  }
  return p;
}

void put_back(const Island& island, const IslandProblem& problem, std::span<ContactRow> rows) {
  for (std::size_t i = 0; i < island.rows.size(); ++i)
    std::copy(problem.rows[i].impulse, problem.rows[i].impulse + 3, rows[island.rows[i]].impulse);
}

}  // namespace sherd
