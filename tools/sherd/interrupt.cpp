#include <csignal>

#include "tools/sherd/commands.h"

namespace sherd {
namespace {

volatile std::sig_atomic_t seen = 0;

extern "C" void note_signal(int signal) {
  seen = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() {
  return seen != 0;
}

}  // namespace sherd
