#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <thread>

#include "kernels/core/parallel.h"
#include "kernels/core/trace.h"

namespace sherd {
namespace {

TEST(Trace, ScopesNestWithinTheirThread) {
  const Trace trace;
  {
    const TraceScope outer("outer", [] { return std::string("a \"body\""); });
    EXPECT_STREQ(TraceScope::innermost(), "outer");
    const TraceScope inner("inner");
    EXPECT_STREQ(TraceScope::innermost(), "inner");
  }
  const std::vector<TraceEvent> events = trace.events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_STREQ(events[0].name, "outer");
  EXPECT_STREQ(events[1].name, "inner");
  EXPECT_EQ(events[0].thread, 0);
  EXPECT_LE(events[0].begin, events[1].begin);
  EXPECT_GE(events[0].end, events[1].end);
  EXPECT_EQ(events[0].detail, "a \"body\"");
}

TEST(Trace, NothingIsRecordedWithoutOne) {
  bool asked = false;
  {
    const TraceScope scope("lost", [&] {
      asked = true;
      return std::string();
    });
    EXPECT_EQ(TraceScope::innermost(), nullptr);
  }
  EXPECT_FALSE(asked);
  EXPECT_TRUE(Trace().events().empty());
}

TEST(Trace, AScopeThatOutlivesItsTraceIsInNone) {
  {
    std::optional<Trace> first(std::in_place);
    const TraceScope scope("between");
    first.reset();
    const Trace second;
    const TraceScope own("own");
  }
  EXPECT_TRUE(Trace().events().empty());
}

TEST(Trace, ChunksOnOtherThreadsCarryTheNameOfTheLoop) {
  const Trace trace;
  {
    const TraceScope scope("loop");
    parallel_for(64, 1, [](std::size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); });
  }
  for (const TraceEvent& e : trace.events()) {
    EXPECT_STREQ(e.name, "loop");
    EXPECT_LE(e.begin, e.end);
  }
}

TEST(Trace, ChromeTextQuotesDetails) {
  const TraceEvent event{"name", "say \"x\\y\"\n", 3, 0.5, 0.75};
  EXPECT_EQ(chrome_trace({&event, 1}),
            "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n"
            "{\"name\":\"name\",\"ph\":\"X\",\"pid\":1,\"tid\":3,\"ts\":500000.000,\"dur\":250000.000,"
            "\"args\":{\"detail\":\"say \\\"x\\\\y\\\" \"}}\n]}\n");
}

}  // namespace
}  // namespace sherd
