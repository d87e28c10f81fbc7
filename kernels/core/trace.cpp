#include "kernels/core/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>

#include "kernels/core/error.h"

namespace sherd {
namespace {

using Clock = std::chrono::steady_clock;

// Of one thread; owned by the recorder, because threads of the pool outlive a trace and end before the process.
struct Track {
  int thread = 0;
  std::vector<TraceEvent> done, open;
};

struct Recorder {
  std::atomic<bool> active{false};
  std::atomic<std::uint64_t> generation{0};  // of the trace: what a thread holds of an earlier one is stale
  Clock::time_point start;
  std::mutex mutex;  // of `tracks`
  std::vector<std::unique_ptr<Track>> tracks;
};

Recorder& recorder() {
  static Recorder instance;
  return instance;
}

Track& track() {
  thread_local Track* mine = nullptr;
  thread_local std::uint64_t generation = 0;
  Recorder& r = recorder();
  const std::uint64_t now = r.generation.load(std::memory_order_acquire);
  if (mine == nullptr || generation != now) {
    const std::lock_guard lock(r.mutex);
    r.tracks.push_back(std::make_unique<Track>());
    mine = r.tracks.back().get(), generation = now;
    mine->thread = static_cast<int>(r.tracks.size()) - 1;
  }
  return *mine;
}

double since_start() {
  return std::chrono::duration<double>(Clock::now() - recorder().start).count();
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

}  // namespace

Trace::Trace() {
  Recorder& r = recorder();
  SHERD_CHECK(!r.active, "two traces at a time");
  r.tracks.clear();
  r.start = Clock::now();
  r.generation.fetch_add(1, std::memory_order_acq_rel);
  track();  // this thread is number 0
  r.active.store(true, std::memory_order_release);
}

Trace::~Trace() {
  recorder().active.store(false, std::memory_order_release);
}

bool Trace::active() {
  return recorder().active.load(std::memory_order_acquire);
}

std::vector<TraceEvent> Trace::events() const {
  Recorder& r = recorder();
  const std::lock_guard lock(r.mutex);
  std::vector<TraceEvent> all;
  for (const auto& t : r.tracks) all.insert(all.end(), t->done.begin(), t->done.end());
  std::stable_sort(all.begin(), all.end(), [](const TraceEvent& a, const TraceEvent& b) {
    return a.thread != b.thread ? a.thread < b.thread : a.begin != b.begin ? a.begin < b.begin : a.end > b.end;
  });
  return all;
}

void TraceScope::open(const char* name) {
  if (!Trace::active()) return;
  Track& t = track();
  depth_ = static_cast<int>(t.open.size());
  t.open.push_back({name, {}, t.thread, since_start(), 0});
}

void TraceScope::describe(std::string detail) {
  track().open[static_cast<std::size_t>(depth_)].detail = std::move(detail);
}

void TraceScope::close() {
  Track& t = track();
  // A trace that ended, or another that began, while the scope was open knows nothing of it.
  if (t.open.size() != static_cast<std::size_t>(depth_) + 1) return;
  t.open.back().end = since_start();
  t.done.push_back(std::move(t.open.back()));
  t.open.pop_back();
}

const char* TraceScope::innermost() {
  if (!Trace::active()) return nullptr;
  const Track& t = track();
  return t.open.empty() ? nullptr : t.open.back().name;
}

std::string chrome_trace(std::span<const TraceEvent> events) {
  std::string text = "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[";
  for (std::size_t i = 0; i < events.size(); ++i) {
    const TraceEvent& e = events[i];
    fmt::format_to(std::back_inserter(text),
                   "{}\n{{\"name\":\"{}\",\"ph\":\"X\",\"pid\":1,\"tid\":{},\"ts\":{:.3f},\"dur\":{:.3f}",
                   i > 0 ? "," : "", e.name, e.thread, 1e6 * e.begin, 1e6 * (e.end - e.begin));
    if (!e.detail.empty()) text += ",\"args\":{\"detail\":\"" + escaped(e.detail) + "\"}";
    text += "}";
  }
  return text + "\n]}\n";
}

}  // namespace sherd
