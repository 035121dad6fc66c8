#pragma once
#include "engine/core/parallel.hpp"

namespace tumble {

/// Work is divided into this many chunks whatever the number of threads.
constexpr size_t chunk_count = 32;
/// Less is not worth waking another thread for.
constexpr size_t least_parallel = 2048;

/// Calls f(chunk, first, last) for the chunks of [0, n), on these threads if there are any and it
/// is worth it: from `least` on.
template <class F>
void for_chunks(tbb::task_arena* arena, size_t n, const F& f, size_t least = least_parallel) {
  if (!arena || n < least) {
    f(size_t{0}, size_t{0}, n);
    return;
  }
  parallel_for(*arena, chunk_count, [&](size_t chunk) {
    f(chunk, n * chunk / chunk_count, n * (chunk + 1) / chunk_count);
  });
}

}  // namespace tumble
