// What a plan does in which order: boxes in chunks, the far pairs of a chunk sorted by translation, and the tasks with
// their dependences. Depends on the points alone, not on threads.
#pragma once
#include "kernels/core/task_graph.h"
#include "kernels/fmm/lists.h"
#include "kernels/fmm/translations.h"

namespace sherd::fmm {

enum class TaskKind : std::uint8_t { kDirect, kUp, kAcross, kDown };
const char* task_name(TaskKind kind);

// Boxes [begin, end) of one level.
struct Chunk {
  Tree::Index begin, end;
};

// Boxes of a chunk that exchange multipoles and locals by the same matrix; sorted by matrix.
struct FarExchange {
  Tree::Index source, target;
  std::uint16_t matrix;
  std::uint8_t flips;
};

class Schedule {
 public:
  // translations: null where the lists name no far pairs.
  Schedule(const Tree& tree, const InteractionLists& lists, const Translations* translations);

  struct Task {
    TaskKind kind;
    std::uint32_t chunk;
  };
  const std::vector<Chunk>& chunks() const { return chunks_; }
  std::span<const FarExchange> exchanges(std::size_t chunk) const { return exchanges_[chunk]; }
  const TaskGraph& graph() const { return graph_; }
  const Task& task(TaskGraph::Task t) const { return tasks_[t]; }

  // Of each leaf with targets, where they start in arrays padded to kPairPad a leaf; and their whole length.
  std::vector<std::size_t> padded;  // per box
  std::size_t padded_size = 0;

 private:
  void add_tasks(const Tree& tree, const InteractionLists& lists);

  std::vector<Chunk> chunks_;
  Rows<FarExchange> exchanges_;
  TaskGraph graph_;
  std::vector<Task> tasks_;
};

}  // namespace sherd::fmm
