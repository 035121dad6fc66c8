#pragma once
#include "engine/geometry/constructions/projections.hpp"
#include "engine/geometry/predicates/integer.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// Planes through corners of a mesh, and intersection points of three of them, without rounding
/// (Sugihara & Iri, "A solid modelling system free from topological inconsistency", 1989; Bernstein
/// & Fussell, "Fast, exact, linear Booleans", 2009; Trettner, Nehring-Wirxel & Kobbelt, "EMBER",
/// 2022). Every plane is given by three corners, and every point is a corner or is on three such
/// planes, however often a solid is cut: numbers do not grow, and each decision is the sign of an
/// integer of bounded size. Doubles with an error bound decide first where they can.
///
/// Coordinates are integers in units of 2^-107 of the largest coordinate, which represents doubles
/// down to 1e-16 of it without rounding.
class ExactSpace {
 public:
  /// The corners, which must be finite, are the points 0, 1, ...
  explicit ExactSpace(std::span<const Vec3> corners = {});

  /// The plane through three points with coordinates up to eight times the largest; its normal
  /// points to the side from which they run counter-clockwise. no_index if they are collinear.
  uint32_t add_plane(const Vec3& a, const Vec3& b, const Vec3& c);
  /// The intersection of three planes that have exactly one common point.
  uint32_t add_point(uint32_t p, uint32_t q, uint32_t r);

  size_t point_count() const { return points_.size(); }
  const Vec3& at(uint32_t point) const { return near_[point]; }  ///< rounded
  const Plane& plane(uint32_t plane) const { return planes_[plane].near; }
  /// Three points on the plane.
  const std::array<Vec3, 3>& through(uint32_t plane) const { return planes_[plane].through; }

  /// 1 above the plane, 0 on it, -1 below.
  int side(uint32_t plane, uint32_t point) const;

  /// A coordinate axis along which points of a line are ordered, and whether the line runs against
  /// it.
  struct Along {
    int axis = 0;
    int sign = 0;  ///< 0: the planes are parallel
  };
  /// For the intersection line with the upper side of the first plane on its left, seen from the
  /// side to which the second plane's normal points.
  Along along(uint32_t first, uint32_t second) const;
  /// -1, 0 or 1: p comes before q on such a line, is the same point, or comes after it.
  int order(const Along& line, uint32_t p, uint32_t q) const;

 private:
  static constexpr int bits = 110;  ///< of a coordinate
  using Coordinate = Integer<bits>;
  using Normal = Integer<2 * (bits + 1) + 1>;
  using Offset = Integer<3 * bits + 5>;
  using Weight = Integer<6 * bits + 12>;
  using Numerator = Integer<7 * bits + 14>;
  struct ExactPlane {
    std::array<Normal, 3> normal;
    Offset offset;
    Plane near;
    std::array<Vec3, 3> through;
  };
  struct ExactPoint {
    std::array<Numerator, 3> x;
    Weight weight;  ///< positive
    std::array<uint32_t, 3> planes;
  };

  int exponent_ = 0;  ///< coordinates are in units of 2^exponent_ m
  std::vector<ExactPlane> planes_;
  std::vector<ExactPoint> points_;
  std::vector<Vec3> near_;  ///< the points, rounded
};

}  // namespace tumble
