// What the tasks of one application did, on paper and for Perfetto.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"
#include "kernels/core/trace.h"
#include "tools/bench/fmm.h"

namespace sherd::bench {
namespace {

using namespace fmm;

void write_chrome(const std::vector<TaskRecord>& records, const std::string& path) {
  std::vector<TraceEvent> events;
  for (const TaskRecord& r : records)
    events.push_back({r.name, fmt::format("{} boxes", r.boxes), r.worker, r.begin, r.end});
  std::ofstream file(path);
  file << chrome_trace(events);
  file.flush();
  if (!file) throw InputError(fmt::format("cannot write {}; choose a folder that exists", path));
}

// Longest chain of tasks that wait for each other, in seconds: no number of threads is faster. Tasks by what they wait
// for.
double critical_path(const TaskGraph& graph, const std::vector<TaskRecord>& records) {
  std::vector<std::uint32_t> waits(graph.size(), 0);
  for (TaskGraph::Task t = 0; t < graph.size(); ++t)
    for (const TaskGraph::Task a : graph.after(t)) ++waits[a];
  std::vector<double> begin(graph.size(), 0);
  std::vector<TaskGraph::Task> ready;
  for (TaskGraph::Task t = 0; t < graph.size(); ++t)
    if (waits[t] == 0) ready.push_back(t);
  double longest = 0;
  while (!ready.empty()) {
    const TaskGraph::Task t = ready.back();
    ready.pop_back();
    const double end = begin[t] + records[t].end - records[t].begin;
    longest = std::max(longest, end);
    for (const TaskGraph::Task a : graph.after(t)) {
      begin[a] = std::max(begin[a], end);
      if (--waits[a] == 0) ready.push_back(a);
    }
  }
  return longest;
}

}  // namespace

void trace_fmm(const FmmProblem& problem, const FmmSetting& setting, const FmmOptions& options,
               const std::string& path) {
  const ThreadLimit limit(setting.threads);
  const Plan plan = problem.plan(setting, static_cast<std::size_t>(options.gigabytes * (1 << 30)));
  std::vector<double> out(problem.outputs() * problem.size());
  plan.apply(problem.strengths(), out);  // so that memory is there
  const double start = wall_seconds();
  const std::vector<TaskRecord> records = plan.apply_traced(problem.strengths(), out);
  const double wall = wall_seconds() - start;
  write_chrome(records, path);
  struct Phase {
    std::size_t tasks = 0, boxes = 0;
    double seconds = 0, longest = 0;
  };
  std::map<std::string, Phase> phases;
  std::map<int, double> busy;
  double all = 0, first = wall, last = 0;
  for (const TaskRecord& r : records) {
    Phase& p = phases[r.name];
    const double seconds = r.end - r.begin;
    ++p.tasks, p.boxes += r.boxes, p.seconds += seconds, p.longest = std::max(p.longest, seconds);
    busy[r.worker] += seconds, all += seconds;
    first = std::min(first, r.begin), last = std::max(last, r.end);
  }
  std::printf("\nTrace of one application: %zu tasks, %.4f s; before the first task %.4f s\n", records.size(), wall,
              first);
  std::printf("%-20s %7s %9s %9s %7s %11s\n", "phase", "tasks", "boxes", "seconds", "share", "longest s");
  for (const auto& [name, p] : phases)
    std::printf("%-20s %7zu %9zu %9.4f %6.1f%% %11.5f\n", name.c_str(), p.tasks, p.boxes, p.seconds,
                100 * p.seconds / all, p.longest);
  for (const auto& [worker, seconds] : busy)
    std::printf("worker %-3d busy %8.4f s, idle %8.4f s between the first task and the last\n", worker, seconds,
                last - first - seconds);
  const double path_seconds = critical_path(plan.tasks(), records);
  std::printf("critical path %.4f s (%.1f %% of all tasks' time: at most %.0f threads are of use)\n%s\n", path_seconds,
              100 * path_seconds / all, all / path_seconds, path.c_str());
}

}  // namespace sherd::bench
