#pragma once
#include "engine/collision/shape.hpp"

#include <array>
#include <span>

namespace tumble {

/// A primitive on its way to a mesh: where it is, and its sizes as its kind understands them.
struct PrimitiveGuess {
  Pose pose;
  std::array<double, 3> size{};  ///< [m]
};

/// A kind of primitive that can be fitted.
struct PrimitiveKind {
  ShapeType type;
  bool round;    ///< about y: of a frame only that axis counts
  bool upright;  ///< its ends differ, so that y and -y are two beginnings
  size_t sizes;  ///< how many sizes it has
  /// Signed distance of a point of its own frame from its surface [m].
  double (*distance)(const std::array<double, 3>& size, const Vec3& p);
  /// Sizes that about fill points of its own frame, whose origin is the middle of their bounds.
  std::array<double, 3> (*begin)(std::span<const Vec3> points, const Vec3& half);
  /// Whether these sizes make a shape.
  bool (*valid)(const std::array<double, 3>& size);
  ShapeDef (*shape)(const std::array<double, 3>& size);
};

/// The simplest first: of two that err alike the earlier one is taken.
std::span<const PrimitiveKind> primitive_kinds();

}  // namespace tumble
