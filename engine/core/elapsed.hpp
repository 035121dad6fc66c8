#pragma once
#include <chrono>

namespace tumble {

/// Wall time since `start` [s]. For reports only, never for decisions.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace tumble
