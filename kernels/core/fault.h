// Places where a test can make the program fail: the law that a failed operation leaves its input as it was is tested
// by throwing at each of them in turn. Without a plan a fault point costs one read of a thread's own variable.
#pragma once
#include <cstddef>
#include <stdexcept>

namespace sherd {

class FaultInjected : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// While it lives, the fault points that its thread passes are counted from 0 and number `at` throws FaultInjected. One
// plan a thread at a time.
class FaultPlan {
 public:
  static constexpr std::size_t kNever = static_cast<std::size_t>(-1);  // only counts

  explicit FaultPlan(std::size_t at);
  ~FaultPlan();
  FaultPlan(const FaultPlan&) = delete;
  FaultPlan& operator=(const FaultPlan&) = delete;

  std::size_t seen() const { return seen_; }

 private:
  friend void fault_point(const char* name);
  std::size_t at_, seen_ = 0;
};

// `name` is in the exception's text.
void fault_point(const char* name);

}  // namespace sherd
