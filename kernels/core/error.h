// Errors. Bad input (scene, mesh, option) throws InputError at the border, with file, place and remedy in its text: the
// command ends with exit code 2. A broken invariant inside throws InternalError through SHERD_CHECK: exit code 1.
// Numerical trouble (no convergence, a crack that fails) is a status in the stage's output, never an exception.
#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace sherd {

class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

#define SHERD_CHECK(condition, ...)                                                                 \
  do {                                                                                              \
    if (!(condition))                                                                               \
      throw ::sherd::InternalError(                                                                 \
          fmt::format("{}:{}: {} ({})", __FILE__, __LINE__, fmt::format(__VA_ARGS__), #condition)); \
  } while (false)

}  // namespace sherd
