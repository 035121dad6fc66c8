#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

namespace tumble {

/// Prefetches the cache lines of [at, at + Bytes), which need not be valid addresses. For loops
/// whose access pattern the hardware cannot predict.
template <size_t Bytes = 1>
void prefetch([[maybe_unused]] const void* at) {
#if defined(__GNUC__)
  for (size_t i = 0; i < Bytes; i += 64) __builtin_prefetch(static_cast<const char*>(at) + i);
#endif
}

/// The same for memory that is about to be written.
template <size_t Bytes = 1>
void prefetch_to_write([[maybe_unused]] const void* at) {
#if defined(__GNUC__)
  for (size_t i = 0; i < Bytes; i += 64) __builtin_prefetch(static_cast<const char*>(at) + i, 1);
#endif
}

/// Prefetches the first Bytes of the element that a loop over `all` reads some steps after i.
template <size_t Bytes = 1, class T>
void prefetch_ahead(std::span<T> all, size_t i, size_t steps = 8) {
  prefetch<Bytes>(&all[std::min(i + steps, all.size() - 1)]);
}

}  // namespace tumble
