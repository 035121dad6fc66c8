#pragma once
#include "engine/collision/gjk/minkowski.hpp"

namespace tumble {

/// One to four points of the difference, with the barycentric weights of the point nearest to the
/// origin.
struct Simplex {
  std::array<DifferencePoint, 4> points;
  std::array<double, 4> weights{1, 0, 0, 0};
  int count = 0;

  void add(const DifferencePoint& p) { points[size_t(count++)] = p; }
  bool contains(const Plain3& w) const {
    for (int i = 0; i < count; ++i)
      if (points[size_t(i)].w == w) return true;
    return false;
  }
  /// Keeps these corners, in this order (each index must be at least its new one).
  void keep(const int* corners, int n) {
    for (int i = 0; i < n; ++i)
      if (corners[i] != i) points[size_t(i)] = points[size_t(corners[i])];
    count = n;
  }
  /// The nearest point, and the points of A and B that it is the difference of.
  Plain3 nearest() const { return weighted(&DifferencePoint::w); }
  Plain3 nearest_a() const { return weighted(&DifferencePoint::a); }
  Plain3 nearest_b() const { return weighted(&DifferencePoint::b); }

 private:
  Plain3 weighted(Plain3 DifferencePoint::*member) const {
    Plain3 p = weights[0] * (points[0].*member);
    for (size_t i = 1; i < size_t(count); ++i) p = p + weights[i] * (points[i].*member);
    return p;
  }
};

/// The point of a simplex nearest to the origin.
struct NearestPoint {
  Plain3 v;
  double vv;     ///< |v|^2
  Plain3 along;  ///< the direction of v, any length: known before v is, so that the next support
                 ///< need not wait for a division
  double vv_rest = 0;  ///< what vv lacks of |v|^2, to double-double precision

  /// Copies number by number, to keep the members in registers.
  void take(const NearestPoint& o) {
    v.x = o.v.x, v.y = o.v.y, v.z = o.v.z;
    along.x = o.along.x, along.y = o.along.y, along.z = o.along.z;
    vv = o.vv, vv_rest = o.vv_rest;
  }
};

enum class Reduction {
  outside,  ///< the nearest point is found, and the simplex is reduced to the corners that span it
  inside,   ///< a tetrahedron contains the origin
  unclear,  ///< too close to decide in double precision; the simplex is unchanged
};

/// Finds the point v of the simplex nearest to the origin, if its last corner is a new support
/// point in the direction from the nearest point of the others to the origin. That corner is then
/// among those that span v, so that only the sides that contain it are tested, by the signs of the
/// volumes and areas that the origin makes with them (Montanari, Petrinic & Barbieri, "Improving
/// the GJK algorithm for faster and more reliable distance queries between convex objects", 2017).
/// Does not set the weights.
Reduction reduce(Simplex& simplex, NearestPoint& v);

/// The same for any simplex: all sides are tested.
Reduction reduce_from_all_sides(Simplex& simplex, NearestPoint& v);

/// Sets the weights of v, the point nearest to the origin, which all corners span. If those of a
/// sliver miss it by more than `tolerance` [m] in double precision, they are computed by
/// reduce_precisely().
void set_weights(Simplex& simplex, const Plain3& v, double tolerance);

/// The same as reduce() for any simplex, in double-double arithmetic, weights included: signs and
/// nearest points of slivers are right down to 1e-24 of their size. Never returns `unclear`.
Reduction reduce_precisely(Simplex& simplex, NearestPoint& v);

}  // namespace tumble
