#pragma once
#include "engine/dynamics/contact/surface/element_jets.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace tumble {

/// Support function of one side of a pair: an ellipsoid by its semi-axes, the disc of a circle by
/// two radii at right angles, anything else by its origin alone; each with a rounding.
template <class Number>
struct SupportSide {
  using Place = Triple<Number>;
  const MovingElement<Number>& element;
  std::array<Place, 3> axes;
  int count = 0;
  double size = 0;

  explicit SupportSide(const MovingElement<Number>& e) : element(e) {
    if (e.kind == ElementKind::ellipsoid) {
      for (int k = 0; k < 3; ++k) add(e.semi_axes.col(k));
    } else if (e.kind == ElementKind::circle) {
      Vec3 u, w;
      tangent_frame(value(e.direction), u, w);
      add(e.radius * u), add(e.radius * w);
    }
  }

  /// The point furthest along n, whose length is `length`; as a Taylor series in time, or with
  /// plain numbers at the present time.
  template <class N>
  Triple<N> furthest(const Triple<N>& n, const N& length) const {
    using std::sqrt;
    Triple<N> p = seen_as<N>(element.origin);
    N height(0);
    for (int k = 0; k < count; ++k) {
      const N along = seen_as<N>(axes[size_t(k)]).dot(n);
      height = height + along * along;
    }
    if (count > 0) {
      height = sqrt(height);
      for (int k = 0; k < count; ++k) {
        const Triple<N> axis = seen_as<N>(axes[size_t(k)]);
        p = p + axis * (axis.dot(n) / height);
      }
    }
    return element.rounding() > 0 ? p + n * (N(element.rounding()) / length) : p;
  }
  double height(const Vec3& n) const {
    double sum = 0;
    for (int k = 0; k < count; ++k) sum += square(value(axes[size_t(k)]).dot(n));
    return std::sqrt(sum);
  }
  /// Second derivatives of the support height at a unit n.
  Mat3 bend(const Vec3& n) const {
    Mat3 out = element.rounding() * (Mat3::Identity() - n * n.transpose());
    if (count == 0) return out;
    Mat3 S = Mat3::Zero();
    for (int k = 0; k < count; ++k) {
      const Vec3 a = value(axes[size_t(k)]);
      S += a * a.transpose();
    }
    const double h = height(n);
    const Vec3 Sn = S * n;
    return out + S / h - Sn * Sn.transpose() / (h * h * h);
  }

 private:
  template <class N>
  static Triple<N> seen_as(const Place& p) {
    if constexpr (std::is_same_v<N, Number>)
      return p;
    else
      return Triple<N>::of(value(p));
  }
  static double square(double x) { return x * x; }
  void add(const Vec3& axis) {
    axes[size_t(count++)] = element.carried(axis);
    size = std::max(size, axis.norm());
  }
};

}  // namespace tumble
