#pragma once
#include <cstddef>

#include <sys/resource.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TUMBLE_TAKES_ADDRESS_SPACE 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TUMBLE_TAKES_ADDRESS_SPACE 1
#endif

namespace tumble {

/// Whether limit_process limits memory: not where a sanitizer takes the address space for itself.
#ifdef TUMBLE_TAKES_ADDRESS_SPACE
inline constexpr bool limits_memory = false;
#else
inline constexpr bool limits_memory = true;
#endif

/// From here on this process ends by a signal when it has used so much processor time, and is
/// given no memory beyond so much; 0: no limit. It leaves no core file.
inline void limit_process(unsigned cpu_seconds, size_t megabytes) {
  if (cpu_seconds > 0) {
    const rlimit cpu{cpu_seconds, cpu_seconds + 1};
    ::setrlimit(RLIMIT_CPU, &cpu);
  }
  if (limits_memory && megabytes > 0) {
    const rlimit memory{megabytes << 20, megabytes << 20};
    ::setrlimit(RLIMIT_AS, &memory);
  }
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

}  // namespace tumble
