#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// A surface of triangles as it is drawn, in the frame of its shape. Counter-clockwise seen from
/// outside. Without normals those of the triangles are smoothed, but not over sharp edges.
struct DrawnSurface {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< one of each position, unit, outward; or none
  std::vector<uint32_t> indices;
};

/// How a shape is drawn: most have a surface of their own (Shape::drawn_surface), some are one of
/// the meshes that every viewer has, stretched.
struct ShapeDrawing {
  enum class Kind : uint8_t {
    surface,   ///< what Shape::drawn_surface() gives, made once for each shape
    ball,      ///< unit ball, stretched
    box,       ///< unit cube
    cylinder,  ///< along y
    capsule,   ///< along y; `half.y()` without the caps
    plane,     ///< y = 0, as far as one sees
  };
  Kind kind = Kind::surface;
  Vec3 half = Vec3::Ones();  ///< semi-axes, half extents, or radius, half height, radius [m]
};

}  // namespace tumble
