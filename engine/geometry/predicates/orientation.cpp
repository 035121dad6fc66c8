#include "engine/geometry/predicates/orientation.hpp"

#include "engine/geometry/predicates/filtered.hpp"

#include <cmath>

namespace tumble {
namespace {

constexpr double unit = Estimate::u;
constexpr double bound_2d = (3.0 + 16.0 * unit) * unit;
constexpr double bound_3d = (7.0 + 56.0 * unit) * unit;

int sign_of(double x) {
  return (x > 0) - (x < 0);
}

int exact(const Vec2& a, const Vec2& b, const Vec2& c) {
  ++exact_fallbacks();
  const Expansion acx = Expansion::difference(a.x(), c.x());
  const Expansion acy = Expansion::difference(a.y(), c.y());
  const Expansion bcx = Expansion::difference(b.x(), c.x());
  const Expansion bcy = Expansion::difference(b.y(), c.y());
  return (acx * bcy - acy * bcx).sign();
}

int exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  ++exact_fallbacks();
  const auto from_d = [&](const Vec3& p, int k) { return Expansion::difference(p[k], d[k]); };
  const Expansion ax = from_d(a, 0), ay = from_d(a, 1), az = from_d(a, 2);
  const Expansion bx = from_d(b, 0), by = from_d(b, 1), bz = from_d(b, 2);
  const Expansion cx = from_d(c, 0), cy = from_d(c, 1), cz = from_d(c, 2);
  const Expansion determinant =
      (bx * cy - by * cx) * az + (cx * ay - cy * ax) * bz + (ax * by - ay * bx) * cz;
  return -determinant.sign();
}

}  // namespace

int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y());
  const double right = (a.y() - c.y()) * (b.x() - c.x());
  const double determinant = left - right;
  if (std::fabs(determinant) > bound_2d * (std::fabs(left) + std::fabs(right))) {
    return sign_of(determinant);
  }
  if (left == 0 && right == 0) return 0;  // exact: products do not underflow
  return exact(a, b, c);
}

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double ax = a.x() - d.x(), ay = a.y() - d.y(), az = a.z() - d.z();
  const double bx = b.x() - d.x(), by = b.y() - d.y(), bz = b.z() - d.z();
  const double cx = c.x() - d.x(), cy = c.y() - d.y(), cz = c.z() - d.z();
  const double bxcy = bx * cy, bycx = by * cx, cxay = cx * ay, cyax = cy * ax, axby = ax * by,
               aybx = ay * bx;
  const double determinant = az * (bxcy - bycx) + bz * (cxay - cyax) + cz * (axby - aybx);
  const double permanent = (std::fabs(bxcy) + std::fabs(bycx)) * std::fabs(az) +
                           (std::fabs(cxay) + std::fabs(cyax)) * std::fabs(bz) +
                           (std::fabs(axby) + std::fabs(aybx)) * std::fabs(cz);
  if (std::fabs(determinant) > bound_3d * permanent) return -sign_of(determinant);
  if (permanent == 0) return 0;  // exact: products do not underflow
  return exact(a, b, c, d);
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto flat = [&](int x, int y) {
    return orientation(Vec2(a[x], a[y]), Vec2(b[x], b[y]), Vec2(c[x], c[y])) == 0;
  };
  return flat(0, 1) && flat(1, 2) && flat(2, 0);
}

}  // namespace tumble
