#pragma once
#include <chrono>

namespace tumble {

/// Time on the wall since `start` [s]. For what is reported, never for what is decided.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace tumble
