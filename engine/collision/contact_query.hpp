#pragma once
#include "engine/collision/polyhedron_feature.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <cstdint>
#include <span>

namespace tumble {

/// The parameters of a search for contacts.
struct ContactQuery {
  double margin = 0;  ///< gaps up to this are contacts (>= 0) [m]
  /// The hierarchy that finds near triangles of two meshes; null for the boxes that every mesh has.
  /// It changes no contact.
  const HierarchyKind* hierarchy = nullptr;
  /// Features (ManifoldPoint::feature) of the points that carried load until now. Where there are
  /// more candidate points than a manifold holds, these are kept unless others are clearly better.
  std::span<const uint64_t> kept = {};
  /// Manifold::closest of the last query, from which the search for the closest features of two
  /// polyhedra starts, and by which meshes stay on their side of open ones; null if there is none.
  const ClosestFeatures* start = nullptr;
  /// If set, and if no contact is found, receives a lower bound on the distance of the shapes, at
  /// least the margin, larger if the search found more [m]. Until they have moved that far relative
  /// to each other, a new search would find nothing. Undefined if contacts are found.
  double* apart = nullptr;
  /// Shapes that have a field (Shape::field) use their triangles instead: for callers that need
  /// contacts to agree to rounding with the time of contact, which ignores fields.
  bool by_triangles = false;

  ContactQuery(double m, const HierarchyKind* kind = nullptr,
               std::span<const uint64_t> features = {})
      : margin(m), hierarchy(kind), kept(features) {}
};

}  // namespace tumble
