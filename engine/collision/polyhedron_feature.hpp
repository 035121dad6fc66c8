#pragma once
#include <array>
#include <cstdint>

namespace tumble {

enum class FeatureKind : uint32_t { vertex, edge, face };

/// A vertex, edge or face of a ConvexPolyhedron, by its number there.
struct PolyhedronFeature {
  FeatureKind kind = FeatureKind::vertex;
  uint32_t index = 0;
  bool operator==(const PolyhedronFeature&) const = default;
};

/// Features of A and of B that are closest to each other.
using ClosestFeatures = std::array<PolyhedronFeature, 2>;

}  // namespace tumble
