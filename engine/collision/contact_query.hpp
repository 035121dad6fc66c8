#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"

namespace tumble {

/// What contacts are asked for, and by which means.
struct ContactQuery {
  double margin = 0;  ///< gaps up to this count (>= 0) [m]
  /// What finds the triangles of two meshes that are near each other; null for the boxes that every
  /// mesh has anyway. It changes no contact.
  const HierarchyKind* hierarchy = nullptr;

  ContactQuery(double m, const HierarchyKind* kind = nullptr) : margin(m), hierarchy(kind) {}
};

}  // namespace tumble
