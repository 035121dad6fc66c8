#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tumble {

/// 64-bit XXH64 of a byte string: the same on every machine and in every version.
uint64_t hash_bytes(const void* data, size_t size, uint64_t seed = 0);
inline uint64_t hash_bytes(std::span<const std::byte> b, uint64_t seed = 0) {
  return hash_bytes(b.data(), b.size(), seed);
}

/// Sixteen lower-case hexadecimal digits.
std::string hash_text(uint64_t hash);

}  // namespace tumble
