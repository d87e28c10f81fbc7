#include "kernels/core/fault.h"

#include <string>

#include "kernels/core/error.h"

namespace sherd {
namespace {

thread_local FaultPlan* current = nullptr;

}  // namespace

FaultPlan::FaultPlan(std::size_t at) : at_(at) {
  SHERD_CHECK(current == nullptr, "a second fault plan on one thread");
  current = this;
}

FaultPlan::~FaultPlan() {
  current = nullptr;
}

void fault_point(const char* name) {
  if (current && current->seen_++ == current->at_) throw FaultInjected(std::string("fault injected at ") + name);
}

}  // namespace sherd
