#pragma once
#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"

#include <array>
#include <vector>

namespace tumble {

/// Calls find(i, local, out) for every i of [0, n), on these threads if there are any, and
/// concatenates what the calls append to `out` in the order of i. A `Local` is created for each
/// chunk of indices.
template <class Local, class T, class Find>
void gather_found(Crew* crew, size_t n, std::vector<T>& out, const Find& find) {
  std::array<std::vector<T>, chunk_count> parts;
  for_chunks(crew, n, [&](size_t chunk, size_t first, size_t last) {
    Local local;
    for (size_t i = first; i < last && !stop_requested(); ++i) find(i, local, parts[chunk]);
  });
  out.clear();
  size_t size = 0;
  for (const auto& part : parts) size += part.size();
  out.reserve(size);
  for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
}

}  // namespace tumble
