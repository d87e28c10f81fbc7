// What ran when, on which thread, for Chrome's trace format (ui.perfetto.dev, chrome://tracing). Off unless a Trace is
// alive: a scope then costs one load. Results never depend on it.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sherd {

struct TraceEvent {
  const char* name = "";      // static storage, no quotes in it
  std::string detail;         // shown beside the name; may be empty
  int thread = 0;             // 0 is the thread that started the trace
  double begin = 0, end = 0;  // s since the start
};

// Records all scopes of the process while alive; one at a time.
class Trace {
 public:
  Trace();
  ~Trace();
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;
  static bool active();
  // By thread, then by begin, outer scopes first. Call while no scope is open on another thread.
  std::vector<TraceEvent> events() const;
};

// One event from construction to destruction. Chunks of parallel loops begun inside carry its name on their threads.
class TraceScope {
 public:
  explicit TraceScope(const char* name) { open(name); }
  // `detail()` gives the text and is called only while tracing.
  template <class Detail>
  TraceScope(const char* name, const Detail& detail) {
    open(name);
    if (depth_ >= 0) describe(detail());
  }
  ~TraceScope() {
    if (depth_ >= 0) close();
  }
  TraceScope(const TraceScope&) = delete;
  TraceScope& operator=(const TraceScope&) = delete;
  // Of the innermost open scope of this thread; nullptr when there is none or nothing is traced.
  static const char* innermost();

 private:
  void open(const char* name);
  void describe(std::string detail);
  void close();
  int depth_ = -1;  // in the thread's stack; -1 while nothing is traced
};

// The file's text: {"traceEvents": [...]}, times in microseconds.
std::string chrome_trace(std::span<const TraceEvent> events);

}  // namespace sherd
