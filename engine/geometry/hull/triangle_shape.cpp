#include "engine/geometry/hull/triangle_shape.hpp"

#include "engine/geometry/predicates/filtered.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// (b - a) x (c - a) from exact differences, with an error of 64 u^2 times the product of the
/// sides.
Vec3 fine_product(const Vec3& a, const Vec3& b, const Vec3& c) {
  using Fine = Triple<DoubleDouble>;
  const Fine n = (Fine::of(b) - Fine::of(a)).cross(Fine::of(c) - Fine::of(a));
  return {n.x.high, n.y.high, n.z.high};
}

Vec3 exact_product(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto u = exact_difference<Expansion>(b, a), w = exact_difference<Expansion>(c, a);
  const auto n = u.cross(w);
  return {n.x.estimate(), n.y.estimate(), n.z.estimate()};
}

}  // namespace

TriangleShape triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c, double good_enough) {
  const Vec3 u = b - a, w = c - a;
  Vec3 n = u.cross(w);
  double area2 = n.norm();
  const double square = std::max({u.squaredNorm(), w.squaredNorm(), (w - u).squaredNorm()});
  // Each component has an error of at most 4 u (|u_y w_z| + |u_z w_y|), the vector sqrt(3) times
  // that, with |u| |w| for the sum; normalisation adds three roundings.
  constexpr double u_round = 0x1p-53, few = 4;
  double uncertain = u_round * (8 * square / area2 + few);
  if (!(uncertain <= good_enough)) {
    n = fine_product(a, b, c);
    area2 = n.norm();
    uncertain = u_round * (64 * u_round * square / area2 + few);
    if (!(uncertain <= 2 * few * u_round)) {
      n = exact_product(a, b, c);
      area2 = n.norm();
      uncertain = 2 * few * u_round;
    }
  }
  const Vec3 normal = area2 > 0 ? Vec3(n / area2) : Vec3(Vec3::Zero());
  return {normal, area2, std::sqrt(square), uncertain};
}

double distance_to_segment(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 along = b - a, from_a = p - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp(along.dot(from_a) / length2, 0.0, 1.0) : 0.0;
  return (from_a - t * along).norm();
}

double distance_to_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal,
                            double height, const Vec3& p) {
  const auto inside = [&](const Vec3& from, const Vec3& to) {
    return normal.dot((to - from).cross(p - from)) >= 0;
  };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::fabs(height);
  return std::min(
      {distance_to_segment(a, b, p), distance_to_segment(b, c, p), distance_to_segment(c, a, p)});
}

}  // namespace tumble
