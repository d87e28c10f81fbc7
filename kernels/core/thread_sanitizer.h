// Tells the thread sanitizer what oneTBB guarantees: its library is not built for the sanitizer, which therefore does
// not see that handing out a task orders memory. Nothing in other builds.
#pragma once

#if defined(__SANITIZE_THREAD__)
extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#endif

namespace sherd {

#if defined(__SANITIZE_THREAD__)
#define SHERD_UNCHECKED_BY_THREAD_SANITIZER __attribute__((noipa, no_sanitize("thread")))
inline void happens_before(void* tag) {
  __tsan_release(tag);
}
inline void happens_after(void* tag) {
  __tsan_acquire(tag);
}
#else
#define SHERD_UNCHECKED_BY_THREAD_SANITIZER
inline void happens_before(void*) {}
inline void happens_after(void*) {}
#endif

}  // namespace sherd
