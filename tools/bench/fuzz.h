// Random scenes by the hundred, each in a process of its own: what crashes, hangs, or breaks a law that holds for any
// scene (tools/campaign/random_scene.h).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace sherd::bench {

struct FuzzOptions {
  std::size_t count = 100;
  std::uint64_t seed = 1;  // of the first; the others follow
  double duration = 2;     // simulated, s
  double seconds = 2;      // of a scene at most; then it is told to stop, and what it did until then is judged
  int threads = 1;
  std::string program;  // the command `sherd`; empty: beside this one
  std::string keep;     // folder for the scenes that failed
  std::string json;
};
// Prints a line for each scene that failed and a summary; 1 when one did.
int run_fuzz(const FuzzOptions& options);

}  // namespace sherd::bench
