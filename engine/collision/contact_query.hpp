#pragma once
#include "engine/collision/polyhedron_feature.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <cstdint>
#include <span>

namespace tumble {

/// What contacts are asked for, and by which means.
struct ContactQuery {
  double margin = 0;  ///< gaps up to this count (>= 0) [m]
  /// What finds the triangles of two meshes that are near each other; null for the boxes that every
  /// mesh has anyway. It changes no contact.
  const HierarchyKind* hierarchy = nullptr;
  /// Features (ManifoldPoint::feature) of the points that carried the pair until now. Where more
  /// points are candidates than a manifold holds, these stay unless others are clearly better.
  std::span<const uint64_t> kept = {};
  /// Manifold::closest of the last time, where the search for the closest features of two polyhedra
  /// starts; null if there was none.
  const ClosestFeatures* start = nullptr;
  /// Where no contact is found, and this is set: a distance that the shapes are sure to keep, at
  /// least the margin; more where the search knew more. Until they have moved that far against each
  /// other, there is no use in looking again. Means nothing where contacts are found [m].
  double* apart = nullptr;
  /// Shapes that have a field (Shape::field) meet others by their triangles all the same: where the
  /// time of contact, which knows no fields, and the contacts must agree to rounding.
  bool by_triangles = false;

  ContactQuery(double m, const HierarchyKind* kind = nullptr,
               std::span<const uint64_t> features = {})
      : margin(m), hierarchy(kind), kept(features) {}
};

}  // namespace tumble
