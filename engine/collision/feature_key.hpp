#pragma once
#include <algorithm>
#include <cstdint>

namespace tumble {

/// Mixes a value into a key (the finaliser of SplitMix64): equal inputs give equal keys, and
/// different ones nearly always different keys.
constexpr uint64_t mix_key(uint64_t key, uint64_t value) {
  uint64_t z = key + 0x9e3779b97f4a7c15ULL * (value + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// An edge by its two vertices, in either order.
constexpr uint64_t edge_key(uint32_t v, uint32_t w) {
  return (uint64_t{std::max(v, w)} << 32) | std::min(v, w);
}

/// Kinds of contact features; part of a point's key.
enum class FeaturePair : uint64_t { vertex_face, face_vertex, edge_edge, closest };

constexpr uint64_t feature_key(FeaturePair kind, uint64_t a, uint64_t b) {
  return mix_key(mix_key(mix_key(0, uint64_t(kind)), a), b);
}

}  // namespace tumble
