#include "kernels/fmm/schedule.h"

#include <algorithm>

#include "kernels/core/parallel.h"
#include "kernels/fmm/pairs.h"

namespace sherd::fmm {
namespace {

// Small enough to share out, large enough for the matrix products of one offset.
constexpr Tree::Index kLeastBoxes = 16, kMostBoxes = 384, kChunksPerLevel = 24;

FarExchange exchange(const FarPair& p, Tree::Index target, const Translations& t) {
  const std::size_t at = offset_index(p.offset[0], p.offset[1], p.offset[2]);
  return {p.source, target, t.offset[at].matrix, t.offset[at].flips};
}

}  // namespace

const char* task_name(TaskKind kind) {
  switch (kind) {
    case TaskKind::kDirect:
      return "near field";
    case TaskKind::kUp:
      return "upward";
    case TaskKind::kAcross:
      return "multipole to local";
    default:
      return "downward";
  }
}

Schedule::Schedule(const Tree& tree, const InteractionLists& lists, const Translations* translations) {
  for (int l = 0; l < tree.level_count(); ++l) {
    const Tree::Index first = tree.level_begin[static_cast<std::size_t>(l)],
                      last = tree.level_begin[static_cast<std::size_t>(l) + 1];
    const Tree::Index size = std::clamp((last - first) / kChunksPerLevel, kLeastBoxes, kMostBoxes);
    for (Tree::Index b = first; b < last; b += size) chunks_.push_back({b, std::min(last, b + size)});
  }
  exchanges_.begin.assign(chunks_.size() + 1, 0);
  for (std::size_t c = 0; c < chunks_.size(); ++c) exchanges_.begin[c + 1] = lists.far.begin[chunks_[c].end];
  exchanges_.item.resize(lists.far.item.size());
  parallel_for(chunks_.size(), 1, [&](std::size_t c) {
    std::size_t at = exchanges_.begin[c];
    for (Tree::Index b = chunks_[c].begin; b < chunks_[c].end; ++b)
      for (const FarPair& p : lists.far[b]) exchanges_.item[at++] = exchange(p, b, *translations);
    std::stable_sort(exchanges_.item.begin() + static_cast<std::ptrdiff_t>(exchanges_.begin[c]),
                     exchanges_.item.begin() + static_cast<std::ptrdiff_t>(at),
                     [](const FarExchange& a, const FarExchange& b) { return a.matrix < b.matrix; });
  });
  padded.assign(tree.box_count(), 0);
  for (Tree::Index b = 0; b < tree.box_count(); ++b) {
    padded[b] = padded_size;
    if (tree.leaf(b)) padded_size += padded_count(tree.targets[b].size());
  }
  add_tasks(tree, lists);
}

void Schedule::add_tasks(const Tree& tree, const InteractionLists& lists) {
  const std::size_t n = chunks_.size();
  std::vector<std::uint32_t> chunk_of(tree.box_count());
  for (std::uint32_t c = 0; c < n; ++c)
    for (Tree::Index b = chunks_[c].begin; b < chunks_[c].end; ++b) chunk_of[b] = c;
  // Task (kind, chunk) = kind * n + chunk: direct sums first, so that they are handed out last and fill the gaps.
  for (const TaskKind kind : {TaskKind::kDirect, TaskKind::kAcross, TaskKind::kDown, TaskKind::kUp})
    for (std::uint32_t c = 0; c < n; ++c) tasks_.push_back({kind, c}), graph_.add();
  const auto direct = [](std::uint32_t c) { return c; };
  const auto across = [n](std::uint32_t c) { return static_cast<std::uint32_t>(n) + c; };
  const auto down = [n](std::uint32_t c) { return static_cast<std::uint32_t>(2 * n) + c; };
  const auto up = [n](std::uint32_t c) { return static_cast<std::uint32_t>(3 * n) + c; };
  std::vector<std::uint32_t> seen(n, 0xFFFFFFFFu);  // by task, so that each edge is drawn once
  const auto wait = [&](std::uint32_t task, std::uint32_t chunk, std::uint32_t before) {
    if (seen[chunk] == task) return;
    seen[chunk] = task;
    graph_.precede(before, task);
  };
  for (std::uint32_t c = 0; c < n; ++c) {
    for (Tree::Index b = chunks_[c].begin; b < chunks_[c].end; ++b)
      for (Tree::Index k = tree.children[b].begin; k < tree.children[b].end; ++k)
        wait(up(c), chunk_of[k], up(chunk_of[k]));
    for (const FarExchange& e : exchanges_[c]) wait(across(c), chunk_of[e.source], up(chunk_of[e.source]));
    graph_.precede(across(c), down(c)), graph_.precede(direct(c), down(c));
    for (Tree::Index b = chunks_[c].begin; b < chunks_[c].end; ++b) {
      if (b > 0) wait(down(c), chunk_of[tree.parent[b]], down(chunk_of[tree.parent[b]]));
      // These lie deeper than the parent, so in other chunks.
      for (const Tree::Index s : lists.multipole[b]) wait(down(c), chunk_of[s], up(chunk_of[s]));
    }
  }
}

}  // namespace sherd::fmm
