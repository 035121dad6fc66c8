#include "engine/geometry/continuous_tests/sphere_sphere.hpp"

#include "engine/geometry/continuous_tests/moving_input.hpp"
#include "engine/geometry/predicates/filtered.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Exact signs of q(t) = c + 2 b t + a t^2 = |x(t)|^2 - r^2 and of quantities derived from it, for
/// the given doubles.
class SphereQuadratic {
 public:
  SphereQuadratic(const MovingSphere& a, const MovingSphere& b) : a_(a), b_(b) {}

  /// Sign of q(t).
  int sign(double t) const {
    return exact_sign([&]<class T>(T) {
      const Triple<T> x = t == 0 ? start<T>() : t == 1 ? end<T>() : start<T>() + way<T>() * t;
      return x.dot(x) - reach<T>();
    });
  }
  /// Sign of q'(t): negative while the centres approach.
  int slope_sign(double t) const {
    return exact_sign([&]<class T>(T) {
      const Triple<T> w = way<T>();
      return (t == 0 ? start<T>() : start<T>() + w * t).dot(w);
    });
  }
  /// Sign of b^2 - a c.
  int discriminant_sign() const {
    return exact_sign([&]<class T>(T) {
      const Triple<T> x = start<T>(), w = way<T>();
      const T along = x.dot(w);
      return along * along - w.dot(w) * (x.dot(x) - reach<T>());
    });
  }
  /// An approximation of the earlier root.
  double root() const {
    const Vec3 x = b_.centre.start - a_.centre.start;
    const Vec3 w = (b_.centre.end - a_.centre.end) - x;
    const double r = a_.radius + b_.radius, along = -x.dot(w), distance = x.norm();
    // b^2 - a c = a r^2 - |x cross w|^2, which loses fewer digits.
    const double d = w.squaredNorm() * r * r - x.cross(w).squaredNorm();
    return (distance - r) * (distance + r) / (along + std::sqrt(std::max(d, 0.0)));
  }

 private:
  template <class T>
  Triple<T> start() const {
    return exact_difference<T>(b_.centre.start, a_.centre.start);
  }
  template <class T>
  Triple<T> end() const {
    return exact_difference<T>(b_.centre.end, a_.centre.end);
  }
  template <class T>
  Triple<T> way() const {
    return end<T>() - start<T>();
  }
  template <class T>
  T reach() const {
    const T r = T::sum(a_.radius, b_.radius);
    return r * r;
  }

  const MovingSphere &a_, &b_;
};

MovingContact sphere_contact(const MovingSphere& a, const MovingSphere& b, double lo, double hi) {
  MovingContact out;
  out.t_lo = lo;
  out.t_hi = hi;
  out.certain = true;
  Vec3 n = b.centre.at(lo) - a.centre.at(lo);
  if (!(n.norm() > 0)) {  // concentric: opposed to the approach
    n = (a.centre.end - a.centre.start) - (b.centre.end - b.centre.start);
  }
  if (n.norm() > 0) out.normal = n.normalized();
  return out;
}

std::optional<MovingContact> first_touch(const MovingSphere& a, const MovingSphere& b) {
  const SphereQuadratic q(a, b);
  if (q.sign(0) <= 0) return sphere_contact(a, b, 0, 0);
  if (q.slope_sign(0) >= 0) return std::nullopt;
  const bool touches = q.slope_sign(1) <= 0 ? q.sign(1) <= 0 : q.discriminant_sign() >= 0;
  if (!touches) return std::nullopt;
  // Before the root q > 0 and decreases; after it q <= 0, or the minimum is passed.
  const double root = std::clamp(q.root(), 0.0, 1.0);
  double lo = root, hi = root;
  for (double width = 0x1p-46;; width *= 8) {
    lo = std::max(0.0, root - width);
    if (lo == 0 || (q.sign(lo) > 0 && q.slope_sign(lo) < 0)) break;
  }
  for (double width = 0x1p-46;; width *= 8) {
    hi = std::min(1.0, root + width);
    if (hi == 1 || q.sign(hi) <= 0 || q.slope_sign(hi) >= 0) break;
  }
  return sphere_contact(a, b, lo, hi);
}

}  // namespace

Result<std::optional<MovingContact>> moving_spheres_contact(const MovingSphere& a,
                                                            const MovingSphere& b) {
  const double centres = largest_magnitude(std::array{&a.centre, &b.centre});
  if (!std::isfinite(centres) || !std::isfinite(a.radius) || !std::isfinite(b.radius)) {
    return not_finite("moving_spheres_contact");
  }
  if (a.radius < 0 || b.radius < 0) {
    return Error{ErrorCode::invalid_argument,
                 "moving_spheres_contact: a radius must be >= 0 m, got " +
                     std::to_string(std::min(a.radius, b.radius)),
                 "", ""};
  }
  const double largest = std::max({centres, a.radius, b.radius});
  // Scaled by a power of two to magnitudes about 1, which is exact except for underflow.
  const double factor =
      largest > 0 ? std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000)) : 1;
  return first_touch({scaled(a.centre, factor), a.radius * factor},
                     {scaled(b.centre, factor), b.radius * factor});
}

}  // namespace tumble
