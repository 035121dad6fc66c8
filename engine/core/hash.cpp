#include "engine/core/hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

namespace tumble {

uint64_t hash_bytes(const void* data, size_t size, uint64_t seed) {
  return XXH64(data, size, seed);
}

std::string hash_text(uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

}  // namespace tumble
