#pragma once
#include "engine/collision/shapes/vertex_cloud.hpp"

namespace tumble {

/// A convex core as plain data, so that iterations with many support queries need no virtual call
/// for each.
struct CoreView {
  enum class Kind : uint8_t {
    general,   ///< only ConvexCore::support() applies
    box,       ///< corners at +-half; a segment or point where half is zero
    vertices,  ///< the convex hull of vertices
  };
  Kind kind = Kind::general;
  double reach = 0;            ///< no point of the core is further from its frame's origin [m]
  Vec3 centre = Vec3::Zero();  ///< some point inside
  Vec3 half = Vec3::Zero();    ///< of a box [m]
  VertexCloudView vertices;

  static CoreView of_box(const Vec3& half) {
    return {Kind::box, half.norm(), Vec3::Zero(), half, {}};
  }
  static CoreView of_vertices(const VertexCloudView& v, double reach, const Vec3& centre) {
    return {Kind::vertices, reach, centre, Vec3::Zero(), v};
  }
  static CoreView of_reach(double reach, const Vec3& centre = Vec3::Zero()) {
    return {Kind::general, reach, centre, Vec3::Zero(), {}};
  }
};

}  // namespace tumble
