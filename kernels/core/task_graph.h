// Tasks that wait for each other, run without barriers.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

namespace sherd {

class TaskGraph {
 public:
  using Task = std::uint32_t;

  // A task without predecessors. Tasks that can start at once are handed out latest first, so that the critical ones
  // come last.
  Task add();
  // `after` starts when `before` has ended. No cycles (a task on one would never run: run() throws InternalError).
  void precede(Task before, Task after);
  std::size_t size() const { return waits_.size(); }
  const std::vector<Task>& after(Task before) const { return next_[before]; }  // what waits for it

  // Calls body(task) for every task, each once, in an order that respects the edges; parallel. May be called again.
  // Bodies must not throw.
  void run(const std::function<void(Task)>& body) const;
  // Which thread of the pool a body runs on, 0 .. threads - 1.
  static int worker();

 private:
  std::vector<std::uint32_t> waits_;  // predecessors of a task
  std::vector<std::vector<Task>> next_;
};

}  // namespace sherd
