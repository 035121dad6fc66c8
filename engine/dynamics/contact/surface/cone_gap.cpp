#include "engine/dynamics/contact/surface/cone_gap.hpp"

#include "engine/dynamics/contact/surface/support_side.hpp"
#include "engine/dynamics/contact/surface/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The meeting with normal n: the point on A lies below that on B along n.
template <class Number>
ElementMeeting<Number> with_normal(const Triple<Number>& n, const Number& gap,
                                   const Triple<Number>& on_b) {
  ElementMeeting<Number> g;
  g.normal = n;
  g.gap = gap;
  g.on_b = on_b;
  g.on_a = on_b - n * gap;
  return g;
}

template <class Number>
ElementMeeting<Number> cone_point(const MovingElement<Number>& cone,
                                  const MovingElement<Number>& point) {
  const Triple<Number>& u = cone.direction;
  const Triple<Number> d = point.origin - cone.origin;
  const Triple<Number> across = d - u * d.dot(u);
  const double size = value(d).norm() + cone.radius + point.radius;
  if (!(value(across).norm() > tolerances::no_direction * size))
    return ElementMeeting<Number>::irregular();
  const double out = std::sqrt((1 - cone.taper) * (1 + cone.taper));
  const Triple<Number> n = across / across.norm() * out - u * cone.taper;
  return with_normal(n, n.dot(d) - Number(cone.radius + point.radius),
                     point.origin - n * point.radius);
}

/// Two cones, or a cone and a line, which is a cone of taper 0.
template <class Number>
ElementMeeting<Number> cone_line(const MovingElement<Number>& a, const MovingElement<Number>& b,
                                 const Vec3& towards_b) {
  const Triple<Number>&u = a.direction, &w = b.direction;
  const Triple<Number> across = u.cross(w);
  const double sine = value(across).norm();
  if (!(sine > tolerances::parallel_lines)) return ElementMeeting<Number>::irregular();
  // n = x u + y w + z u x w with n.u = -taper_a and n.w = taper_b.
  const Number c = u.dot(w), sine2 = across.dot(across);
  const Number x = -(Number(a.taper) + c * Number(b.taper)) / sine2;
  const Number y = (Number(b.taper) + c * Number(a.taper)) / sine2;
  const Number rest = Number(1) - x * x - y * y - x * y * c * Number(2);
  if (!(value(rest) > tolerances::parallel_lines * tolerances::parallel_lines))
    return ElementMeeting<Number>::irregular();
  using std::sqrt;
  const double side = value(across).dot(towards_b) < 0 ? -1 : 1;
  const Triple<Number> n = u * x + w * y + across * (sqrt(rest / sine2) * Number(side));
  const Triple<Number> d = b.origin - a.origin;
  const Number radii(a.radius + b.radius);
  const Number gap = n.dot(d) - radii;
  // The touching generators run along u + taper_a n and w - taper_b n, both perpendicular to n.
  const Triple<Number> along_a = u + n * a.taper, along_b = w - n * b.taper;
  const Triple<Number> between = n * (gap + radii) - d;
  const Number s = between.cross(along_a).dot(n) / along_b.cross(along_a).dot(n);
  return with_normal(n, gap, b.origin - n * b.radius + along_b * s);
}

/// Separation of a cone and the other side along the normals of the cone, as a function of the
/// angle about its axis.
template <class Number>
class ConeSeparation {
 public:
  ConeSeparation(const MovingElement<Number>& cone, const MovingElement<Number>& other)
      : cone_(cone),
        other_(other),
        u_(value(cone.direction).normalized()),
        origin_(value(cone.origin)),
        out_(std::sqrt((1 - cone.taper) * (1 + cone.taper))) {}

  /// Climbs to the greatest separation near n; false where there is no maximum.
  bool climb(const Vec3& n) {
    e_ = n - u_.dot(n) * u_;
    if (!(e_.norm() > tolerances::no_direction)) return false;
    e_.normalize();
    double last = 1;
    for (int k = 0; k < tolerances::newton_iterations; ++k) {
      if (edge_on()) return false;
      const double f = separation(e_), slope = out_ * tangent().dot(apart(normal(e_)));
      double steep = steepness();
      if (!(steep > least())) steep = std::fabs(steep) + tolerances::newton_damping * other_.size;
      const double turn = std::clamp(slope / steep, -tolerances::newton_longest_step,
                                     tolerances::newton_longest_step);
      if (!std::isfinite(turn)) return false;
      const auto turned = [&](double part) -> Vec3 {
        return (e_ + part * turn * tangent()).normalized();
      };
      Vec3 next = turned(1);
      for (double part = 0.5;
           part > tolerances::newton_shortest_share &&
           separation(next) < f - tolerances::separation_rounding * (other_.size + std::fabs(f));
           part *= 0.5)
        next = turned(part);
      // Near the solution the steps shrink quadratically, until they are rounding error.
      const double length = std::fabs(turn);
      const bool done = length <= tolerances::newton_converged ||
                        (length < tolerances::newton_quadratic && length > 0.5 * last);
      last = length;
      e_ = next;
      if (done) return true;
    }
    return false;
  }

  ElementMeeting<Number> meeting() const {
    const double steep = steepness();
    if (edge_on() || !(steep > least())) return ElementMeeting<Number>::irregular();
    const Place u = cone_.direction, e0 = cone_.carried(e_), t0 = cone_.carried(tangent());
    Number s{};
    Place n{};
    for (int pass = 0;; ++pass) {
      const Place m = e0 + t0 * s;
      const Number length = m.norm();
      n = m / length * out_ - u * cone_.taper;
      if (pass == 3) break;
      const Place w = other_.furthest(-n, Number(1)) - cone_.origin;
      s = s + (t0 - e0 * s).dot(w) / length * Number(out_ / steep);
    }
    const Place on_other = other_.furthest(-n, Number(1));
    return with_normal(n, n.dot(on_other - cone_.origin) - Number(cone_.radius), on_other);
  }

 private:
  using Place = Triple<Number>;

  Vec3 tangent() const { return u_.cross(e_); }
  Vec3 normal(const Vec3& e) const { return out_ * e - cone_.taper * u_; }
  /// From the cone's origin to the other side's point furthest against n.
  Vec3 apart(const Vec3& n) const { return other_.furthest(Plain3::of(-n), 1.0).vec() - origin_; }
  double separation(const Vec3& e) const { return normal(e).dot(apart(normal(e))); }
  /// Minus the second derivative of the separation by the angle.
  double steepness() const {
    const Vec3 t = tangent(), n = normal(e_);
    return out_ * e_.dot(apart(n)) + out_ * out_ * t.dot(other_.bend(n) * t);
  }
  double least() const { return tolerances::singular * (other_.size + cone_.radius); }
  bool edge_on() const {
    return other_.count > 0 &&
           !(other_.height(normal(e_)) > tolerances::no_direction * other_.size);
  }

  const MovingElement<Number>& cone_;
  SupportSide<Number> other_;
  Vec3 u_, origin_;
  double out_;
  Vec3 e_ = Vec3::UnitX();  ///< unit, perpendicular to the axis: n = out_ e_ - taper u_
};

template <class Number>
ElementMeeting<Number> from_cone(const MovingElement<Number>& cone,
                                 const MovingElement<Number>& other, const Vec3& towards_other) {
  if (other.kind == ElementKind::point) return cone_point(cone, other);
  if (other.kind == ElementKind::line || other.kind == ElementKind::cone)
    return cone_line(cone, other, towards_other);
  ConeSeparation<Number> separation(cone, other);
  if (!separation.climb(towards_other)) return ElementMeeting<Number>::irregular();
  return separation.meeting();
}

}  // namespace

template <class Number>
ElementMeeting<Number> cone_gap(const MovingElement<Number>& a, const MovingElement<Number>& b,
                                const Vec3& towards_b) {
  if (a.kind == ElementKind::cone) return from_cone(a, b, towards_b);
  ElementMeeting<Number> g = from_cone(b, a, Vec3(-towards_b));
  std::swap(g.on_a, g.on_b);
  g.normal = -g.normal;
  return g;
}

template ElementMeeting<double> cone_gap(const MovingElement<double>&, const MovingElement<double>&,
                                         const Vec3&);
template ElementMeeting<Jet> cone_gap(const MovingElement<Jet>&, const MovingElement<Jet>&,
                                      const Vec3&);

}  // namespace tumble
