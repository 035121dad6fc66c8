#pragma once
#include "engine/geometry/constructions/projections.hpp"
#include "engine/geometry/predicates/integer.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// Planes through corners of a mesh and points where three of them meet, none of them rounded
/// (Sugihara & Iri, "A solid modelling system free from topological inconsistency", 1989; Bernstein
/// & Fussell, "Fast, exact, linear Booleans", 2009; Trettner, Nehring-Wirxel & Kobbelt, "EMBER",
/// 2022). Every plane goes through three corners and every point is a corner or lies on three
/// planes, however often a solid is cut: numbers do not grow, and each decision is the sign of a
/// whole number of known size. Doubles with a bound of their error decide where they can.
///
/// Coordinates are whole numbers of the 2^-107th part of the largest: doubles down to 1e-16 of it
/// are such without rounding.
class ExactSpace {
 public:
  /// Corners, which are finite, have the numbers 0, 1, ... as points.
  explicit ExactSpace(std::span<const Vec3> corners = {});

  /// The plane through three points with coordinates up to eight times the largest; seen from where
  /// its normal points they run counter-clockwise. no_index when they are collinear.
  uint32_t add_plane(const Vec3& a, const Vec3& b, const Vec3& c);
  /// Where three planes meet that have just one point in common.
  uint32_t add_point(uint32_t p, uint32_t q, uint32_t r);

  size_t point_count() const { return points_.size(); }
  const Vec3& at(uint32_t point) const { return near_[point]; }  ///< rounded
  const Plane& plane(uint32_t plane) const { return planes_[plane].near; }
  /// Three points that the plane goes through.
  const std::array<Vec3, 3>& through(uint32_t plane) const { return planes_[plane].through; }

  /// 1 over the plane, 0 on it, -1 beneath.
  int side(uint32_t plane, uint32_t point) const;

  /// An axis along which points on a line differ, and whether the line runs against it.
  struct Along {
    int axis = 0;
    int sign = 0;  ///< 0: the planes are parallel
  };
  /// Of the line that has the upper side of the first plane on its left, seen from where the second
  /// one's normal points.
  Along along(uint32_t first, uint32_t second) const;
  /// -1, 0 or 1 as p comes before q on such a line, is the same point, or comes after it.
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
