#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

namespace tumble {

/// Asks for the cache lines of [at, at + Bytes) a while before they are read; wherever it points,
/// nothing else happens. For loops whose steps are too wide for the hardware to foresee.
template <size_t Bytes = 1>
void prefetch([[maybe_unused]] const void* at) {
#if defined(__GNUC__)
  for (size_t i = 0; i < Bytes; i += 64) __builtin_prefetch(static_cast<const char*>(at) + i);
#endif
}

/// The same for what is about to be written.
template <size_t Bytes = 1>
void prefetch_to_write([[maybe_unused]] const void* at) {
#if defined(__GNUC__)
  for (size_t i = 0; i < Bytes; i += 64) __builtin_prefetch(static_cast<const char*>(at) + i, 1);
#endif
}

/// The first Bytes of what a loop over `all` reads some steps after i.
template <size_t Bytes = 1, class T>
void prefetch_ahead(std::span<T> all, size_t i, size_t steps = 8) {
  prefetch<Bytes>(&all[std::min(i + steps, all.size() - 1)]);
}

}  // namespace tumble
