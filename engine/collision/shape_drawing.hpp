#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// A surface of triangles for drawing, in the frame of its shape. Counter-clockwise seen from
/// outside. Without normals those of the triangles are smoothed, except across sharp edges.
struct DrawnSurface {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< one per position, unit, outward; or none
  std::vector<uint32_t> indices;
};

/// How a shape is drawn: most have a surface of their own (Shape::drawn_surface), some are a
/// standard mesh of the viewer, scaled.
struct ShapeDrawing {
  enum class Kind : uint8_t {
    surface,   ///< what Shape::drawn_surface() gives, made once for each shape
    ball,      ///< unit ball, scaled
    box,       ///< unit cube
    cylinder,  ///< along y
    capsule,   ///< along y; `half.y()` without the caps
    plane,     ///< y = 0, without end
  };
  Kind kind = Kind::surface;
  Vec3 half = Vec3::Ones();  ///< semi-axes, half extents, or radius, half height, radius [m]
};

}  // namespace tumble
