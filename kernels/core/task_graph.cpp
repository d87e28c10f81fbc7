#include "kernels/core/task_graph.h"

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <memory>

#include "kernels/core/error.h"
#include "kernels/core/thread_sanitizer.h"

namespace sherd {

TaskGraph::Task TaskGraph::add() {
  waits_.push_back(0);
  next_.emplace_back();
  return static_cast<Task>(waits_.size() - 1);
}

void TaskGraph::precede(Task before, Task after) {
  next_[before].push_back(after);
  ++waits_[after];
}

int TaskGraph::worker() {
  return tbb::this_task_arena::current_thread_index();
}

namespace {

struct Run {
  const std::vector<std::vector<TaskGraph::Task>>& next;
  const std::function<void(TaskGraph::Task)>& body;
  std::unique_ptr<std::atomic<std::uint32_t>[]> waits;
  std::atomic<std::size_t> done{0};
  tbb::task_group group;

  // The call that oneTBB makes reads its own copy of `this` and `task` before the order can be declared.
  void start(TaskGraph::Task task) {
    happens_before(this);
    group.run([this, task]() SHERD_UNCHECKED_BY_THREAD_SANITIZER { execute(task); });
  }

  void execute(TaskGraph::Task task) {
    happens_after(this);
    body(task);
    done.fetch_add(1, std::memory_order_relaxed);
    // The decrement that reaches zero sees what all predecessors wrote.
    for (const TaskGraph::Task t : next[task])
      if (waits[t].fetch_sub(1, std::memory_order_acq_rel) == 1) start(t);
    happens_before(&group);
  }
};

}  // namespace

void TaskGraph::run(const std::function<void(Task)>& body) const {
  Run run{next_, body, std::make_unique<std::atomic<std::uint32_t>[]>(waits_.size()), {}, {}};
  for (std::size_t t = 0; t < waits_.size(); ++t) run.waits[t].store(waits_[t], std::memory_order_relaxed);
  for (std::size_t t = 0; t < waits_.size(); ++t)
    if (waits_[t] == 0) run.start(static_cast<Task>(t));
  run.group.wait();
  happens_after(&run.group);
  if (run.done != waits_.size()) throw InternalError("tasks wait for each other in a circle");
}

}  // namespace sherd
