// Groups of bodies that touch one another: each is a contact problem of its own, solved beside the others.
#pragma once
#include <span>
#include <vector>

#include "engine/rigid/solver.h"

namespace sherd {

// Motions and rows of one island, ascending, by number in the whole. Motions that do not move join nothing.
struct Island {
  std::vector<std::uint32_t> motions, rows;
  bool anchored = false;  // touches something that does not move
};

std::vector<Island> islands(std::span<const Motion> motions, std::span<const ContactRow> rows);

// The island's own problem: motions and rows with numbers of their own, all that does not move as one last motion.
struct IslandProblem {
  std::vector<Motion> motions;
  std::vector<ContactRow> rows;
};
IslandProblem isolate(const Island& island, std::span<const Motion> motions, std::span<const ContactRow> rows);
// Puts the island's impulses back.
void put_back(const Island& island, const IslandProblem& problem, std::span<ContactRow> rows);

}  // namespace sherd
