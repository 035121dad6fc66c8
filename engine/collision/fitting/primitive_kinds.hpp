#pragma once
#include "engine/collision/shape.hpp"

#include <array>
#include <span>

namespace tumble {

/// A primitive during a fit: its pose, and its sizes in the order of its kind.
struct PrimitiveGuess {
  Pose pose;
  std::array<double, 3> size{};  ///< [m]
};

/// A kind of primitive that can be fitted.
struct PrimitiveKind {
  ShapeType type;
  bool round;    ///< a solid of revolution about y
  bool upright;  ///< its ends differ, so that y and -y are different starts
  size_t sizes;  ///< how many sizes it has
  /// Signed distance of a point of its own frame from its surface [m].
  double (*distance)(const std::array<double, 3>& size, const Vec3& p);
  /// Initial sizes, for points in its own frame, whose origin is the centre of their bounds.
  std::array<double, 3> (*begin)(std::span<const Vec3> points, const Vec3& half);
  /// Whether these sizes make a shape.
  bool (*valid)(const std::array<double, 3>& size);
  ShapeDef (*shape)(const std::array<double, 3>& size);
};

/// In the order of simplicity: of two kinds with equal errors the earlier one is preferred.
std::span<const PrimitiveKind> primitive_kinds();

}  // namespace tumble
