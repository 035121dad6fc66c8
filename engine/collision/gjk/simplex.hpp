#pragma once
#include "engine/collision/gjk/minkowski.hpp"

namespace tumble {

/// One to four points of the difference, with the weights of the point nearest to the origin.
struct Simplex {
  std::array<DifferencePoint, 4> points;
  std::array<double, 4> weights{1, 0, 0, 0};
  int count = 0;

  Vec3 nearest() const {
    Vec3 v = weights[0] * points[0].w;
    for (size_t i = 1; i < size_t(count); ++i) v += weights[i] * points[i].w;
    return v;
  }
  Vec3 nearest_a() const {
    Vec3 v = weights[0] * points[0].a;
    for (size_t i = 1; i < size_t(count); ++i) v += weights[i] * points[i].a;
    return v;
  }
  Vec3 nearest_b() const {
    Vec3 v = weights[0] * points[0].b;
    for (size_t i = 1; i < size_t(count); ++i) v += weights[i] * points[i].b;
    return v;
  }
};

/// Finds the point of the simplex nearest to the origin, keeps the fewest corners that carry it,
/// and sets their weights. Returns true when the simplex has volume and the origin is inside.
///
/// Signed volumes (Montanari, Petrinic, Barbieri, "Improving the GJK algorithm for faster and more
/// reliable distance queries between convex objects", 2017): weights are ratios of lengths, areas
/// and volumes projected on the axis where they are largest, so that slivers cost no accuracy.
/// Where signs are in doubt all sides are tried and the nearest wins.
bool reduce(Simplex& simplex);

}  // namespace tumble
