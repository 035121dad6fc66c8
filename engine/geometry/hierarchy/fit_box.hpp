#pragma once
#include "engine/math/float4.hpp"

#include <array>
#include <span>

namespace tumble {

/// The extreme points along seven directions, both ways. Those of a union follow from those of its
/// parts.
class ExtremePoints {
 public:
  static constexpr size_t directions = 7;

  /// Of one point (fourth lane 0).
  explicit ExtremePoints(Float4 p);
  void include(Float4 p);
  void include(const ExtremePoints& other);
  /// All fourteen, the lowest first.
  const std::array<Float4, 2 * directions>& points() const { return points_; }

 private:
  std::array<float, 2 * directions> heights_;  // lowest of each direction, then highest
  std::array<Float4, 2 * directions> points_;
};

/// A box with its own axes in single precision.
struct FittedBox {
  Rows3 axes = Rows3::identity();  ///< rows are the axes, of unit length up to rounding
  Float4 centre, half;
};

/// Axes of a tight box (Larsson & Kallberg, "Fast Computation of Tight-Fitting Oriented Bounding
/// Boxes", 2011, DiTO-14): of all boxes with a face on one of the seven triangles of the
/// ditetrahedron of the extreme points and an edge along one of that triangle's, the one with the
/// least area about these points. Rows are the axes. Identity for points that are all equal.
Rows3 tight_axes(const ExtremePoints& extreme);

/// The box along `axes` that contains all points, or the axis-aligned one if that has less area.
FittedBox fit_box(std::span<const Float4> points, const Rows3& axes);

}  // namespace tumble
