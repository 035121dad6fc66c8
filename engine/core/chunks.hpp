#pragma once
#include "engine/core/crew.hpp"

namespace tumble {

/// Work is divided into at most this many chunks, in a way that depends on its size only, and not
/// on the number of threads.
constexpr size_t chunk_count = 32;
/// Shorter loops are not worth running on several threads.
constexpr size_t least_parallel = 256;

/// Calls f(chunk, first, last) for the chunks of [0, n), on these threads if there are any and n is
/// at least `least`.
template <class F>
void for_chunks(Crew* crew, size_t n, const F& f, size_t least = least_parallel) {
  if (!crew || n < least) {
    f(size_t{0}, size_t{0}, n);
    return;
  }
  const size_t chunks = std::clamp(2 * n / std::max(least, size_t{1}), size_t{1}, chunk_count);
  crew->each(chunks, [&](size_t chunk) { f(chunk, n * chunk / chunks, n * (chunk + 1) / chunks); });
}

}  // namespace tumble
