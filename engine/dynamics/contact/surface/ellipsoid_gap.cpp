#include "engine/dynamics/contact/surface/ellipsoid_gap.hpp"

#include "engine/dynamics/contact/surface/support_side.hpp"
#include "engine/dynamics/contact/surface/tolerances.hpp"

#include <cmath>
#include <optional>

namespace tumble {
namespace {

/// Directions near n0: n0 + s e1 + u e2, where the vectors turn with one of the bodies;
/// perpendicular to a line there is s only.
struct Directions {
  Vec3 n0, e1, e2;
  bool across_line;

  /// `line`: its direction, if a side is a line.
  Directions(const Vec3& n, const std::optional<Vec3>& line)
      : n0(n), across_line(line.has_value()) {
    if (line) {
      e1 = line->cross(n0);
      e2 = Vec3::Zero();
    } else {
      tangent_frame(n0, e1, e2);
    }
  }
};

/// Minus the second derivatives of the separation by the two parameters, on the unit sphere.
struct Steepness {
  double ss, su, uu;

  Steepness(const Mat3& bend, double separation, const Directions& d) {
    ss = d.e1.dot(bend * d.e1) + separation;
    su = d.across_line ? 0 : d.e1.dot(bend * d.e2);
    uu = d.across_line ? 1 : d.e2.dot(bend * d.e2) + separation;
  }
  /// Whether the separation has a strict maximum here.
  bool regular(double size) const {
    const double trace = std::fabs(ss) + std::fabs(uu);
    return ss > 0 && uu > 0 && ss * uu - su * su > tolerances::singular * trace * trace &&
           ss > tolerances::singular * size;
  }
  template <class Number>
  std::pair<Number, Number> solve(const Number& fs, const Number& fu) const {
    const Number scale(1 / (ss * uu - su * su));
    return {(fs * Number(uu) - fu * Number(su)) * scale,
            (fu * Number(ss) - fs * Number(su)) * scale};
  }
};

template <class Number>
class Separation {
 public:
  Separation(const MovingElement<Number>& a, const MovingElement<Number>& b)
      : a_(a), b_(b), size_(std::max(a_.size, b_.size)) {
    for (const MovingElement<Number>* e : {&b, &a})
      if (e->kind == ElementKind::line) line_ = e, along_ = value(e->direction).normalized();
  }

  double of(const Vec3& n) const { return n.dot(apart_now(n)); }
  /// Climbs to the greatest separation near n; false where there is no maximum.
  bool climb(Vec3& n) const {
    if (along_) n -= along_->dot(n) * *along_;
    if (!(n.norm() > tolerances::no_direction)) return false;
    n.normalize();
    double last = 1;
    for (int k = 0; k < tolerances::newton_iterations; ++k) {
      if (edge_on(n)) return false;
      const double f = of(n);
      const Directions d(n, along_);
      const Mat3 bend = bend_at(n);
      const Vec3 w = apart_now(n);
      Steepness steep(bend, f, d);
      if (!steep.regular(size_))
        steep = Steepness(bend, std::fabs(f) + tolerances::newton_damping * size_, d);
      const auto [s, u] = steep.solve(d.e1.dot(w), d.e2.dot(w));
      const Vec3 step = limited(s * d.e1 + u * d.e2);
      if (!step.allFinite()) return false;
      Vec3 next = (n + step).normalized();
      for (double part = 0.5;
           part > tolerances::newton_shortest_share &&
           of(next) < f - tolerances::separation_rounding * (size_ + std::fabs(f));
           part *= 0.5)
        next = (n + part * step).normalized();
      // Near the solution the steps shrink quadratically, until they are rounding error.
      const double length = step.norm();
      const bool done = length <= tolerances::newton_converged ||
                        (length < tolerances::newton_quadratic && length > 0.5 * last);
      last = length;
      n = next;
      if (done) return true;
    }
    return false;
  }

  ElementMeeting<Number> meeting(const Vec3& n) const {
    const Directions d(n, along_);
    const Steepness steep(bend_at(n), of(n), d);
    if (edge_on(n) || !steep.regular(size_)) return ElementMeeting<Number>::irregular();
    const MovingElement<Number>& carrier = line_ ? *line_ : b_.element;
    const Place n0 = carrier.carried(d.n0), e1 = carrier.carried(d.e1), e2 = carrier.carried(d.e2);
    Number s{}, u{}, length{};
    const auto direction = [&] { return n0 + e1 * s + e2 * u; };
    for (int pass = 0; pass < 3; ++pass) {
      const Place m = direction();
      length = m.norm();
      const Place w = apart(m, length);
      // The gradient of the separation by s and u: the part of w perpendicular to m.
      const Number f = w.dot(m) / (length * length);
      const auto [ds, du] = steep.solve(w.dot(e1) - f * m.dot(e1), w.dot(e2) - f * m.dot(e2));
      s = s + ds, u = u + du;
    }
    Place m = direction();
    m = m / m.norm();
    ElementMeeting<Number> g;
    g.normal = m;
    g.gap = apart(m, Number(1)).dot(m);
    // A line extends through whichever of its points is nearest to the other side.
    g.on_a = a_.furthest(m, Number(1));
    g.on_b = b_.furthest(-m, Number(1));
    if (line_ == &a_.element) g.on_a = g.on_b - m * g.gap;
    if (line_ == &b_.element) g.on_b = g.on_a + m * g.gap;
    return g;
  }

 private:
  using Place = Triple<Number>;
  /// From A's furthest point along n to B's furthest against it: the gradient of the separation.
  template <class N>
  Triple<N> apart(const Triple<N>& n, const N& length) const {
    return b_.furthest(-n, length) - a_.furthest(n, length);
  }
  Vec3 apart_now(const Vec3& n) const { return apart(Plain3::of(n), 1.0).vec(); }
  Mat3 bend_at(const Vec3& n) const { return a_.bend(n) + b_.bend(n); }
  bool edge_on(const Vec3& n) const {
    return (a_.count > 0 && !(a_.height(n) > tolerances::no_direction * a_.size)) ||
           (b_.count > 0 && !(b_.height(n) > tolerances::no_direction * b_.size));
  }
  static Vec3 limited(const Vec3& step) {
    constexpr double longest = tolerances::newton_longest_step;
    const double length = step.norm();
    return length > longest ? Vec3(longest / length * step) : step;
  }

  SupportSide<Number> a_, b_;
  double size_;
  const MovingElement<Number>* line_ = nullptr;
  std::optional<Vec3> along_;  ///< the line's direction
};

}  // namespace

template <class Number>
ElementMeeting<Number> ellipsoid_plane(const MovingElement<Number>& ellipsoid,
                                       const MovingElement<Number>& plane) {
  const Triple<Number>& up = plane.direction;
  const Triple<Number> lowest = SupportSide<Number>(ellipsoid).furthest(-up, Number(1));
  ElementMeeting<Number> g;
  g.normal = -up;
  g.gap = up.dot(lowest - plane.origin);
  g.on_a = lowest;
  g.on_b = lowest - up * g.gap;
  return g;
}

template <class Number>
ElementMeeting<Number> ellipsoid_curve(const MovingElement<Number>& a,
                                       const MovingElement<Number>& b, const Vec3& towards_b) {
  const Separation<Number> separation(a, b);
  Vec3 n = towards_b;
  if (!separation.climb(n)) return ElementMeeting<Number>::irregular();
  return separation.meeting(n);
}

template ElementMeeting<double> ellipsoid_plane(const MovingElement<double>&,
                                                const MovingElement<double>&);
template ElementMeeting<double> ellipsoid_curve(const MovingElement<double>&,
                                                const MovingElement<double>&, const Vec3&);
template ElementMeeting<Jet> ellipsoid_plane(const MovingElement<Jet>&, const MovingElement<Jet>&);
template ElementMeeting<Jet> ellipsoid_curve(const MovingElement<Jet>&, const MovingElement<Jet>&,
                                             const Vec3&);

}  // namespace tumble
