#include "engine/geometry/continuous_tests/moving_hull.hpp"

#include "engine/geometry/constructions/closest_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double half_ulp = 0x1p-53;
/// Limit of steps. Of tens of thousands of difficult queries, those that took more than 176 did not
/// converge soon.
constexpr int most_march_steps = 192;
constexpr double shortest_step = 0x1p-50;

/// The hull at one time, with up to two candidate directions that separate it from the origin.
struct HullMoment {
  double t = 0;
  std::array<Vec3, 4> corner;
  Vec4 weights = Vec4::Zero();  ///< of the nearest point
  double distance = 0;          ///< of the nearest point, approximately
  std::array<Vec3, 2> direction{Vec3::Zero(), Vec3::Zero()};
  std::array<double, 2> margin{-1, -1};  ///< least dot product of a direction with the corners [m]

  int best() const { return margin[1] > margin[0] ? 1 : 0; }
};

Vec3 unit_or_zero(const Vec3& v) {
  const double length = v.norm();
  return length > 1e-150 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// Removes from v its component along e; twice, since once leaves a residue of the rounding of v.
void remove_along(const Vec3& e, double square, Vec3& v) {
  if (!(square > 0)) return;
  for (int k = 0; k < 2; ++k) v -= (v.dot(e) / square) * e;
}

class HullMarch {
 public:
  HullMarch(const MovingHull& hull, double separation)
      : start_(hull.start), end_(hull.end), n_(hull.corners), separation_(separation) {
    double size = 0;
    for (int i = 0; i < n_; ++i) {
      size = std::max(
          {size, start_[size_t(i)].cwiseAbs().maxCoeff(), end_[size_t(i)].cwiseAbs().maxCoeff()});
    }
    // Scaled by a power of two to magnitudes about 1, which is exact.
    if (size > 0 && (size < 0x1p-100 || size > 0x1p100)) {
      const double factor = std::ldexp(1.0, -std::clamp(std::ilogb(size), -1000, 1000));
      for (int i = 0; i < n_; ++i) {
        start_[size_t(i)] *= factor;
        end_[size_t(i)] *= factor;
      }
      size *= factor;
      separation_ *= factor;
    }
    // A corner at time t has at most 5 units of rounding per coordinate, and its product with a
    // direction 3 units of its length: together under 15 for a size measured by the largest
    // coordinate.
    rounding_ = 20 * half_ulp * size;
    needed_ = separation_ * (1 + 8 * half_ulp) + rounding_;
  }

  std::optional<MovingContact> run(double from) const {
    HullMoment now = moment(from);
    double step = 1 - from;
    for (int k = 0; k < most_march_steps; ++k) {
      const double room = now.margin[size_t(now.best())] - needed_;
      if (!(room > 2 * rounding_)) return in_doubt(now);
      if (!(now.t < 1)) return std::nullopt;
      const double left = 1 - now.t;
      step = std::min(step, left);
      if (step < shortest_step && step < left) return in_doubt(now);
      HullMoment next = moment(step >= left ? 1 : now.t + step);
      if (free_between(now, next)) {
        const double done = next.t - now.t;
        now = next;
        step = std::max(std::min(towards_contact(now), 8 * done), 0.99 * sure_step(now));
        continue;
      }
      const double sure = 0.99 * sure_step(now);
      if (step <= sure) return in_doubt(now);
      step = std::max(sure, std::min(0.25 * step, towards_contact(now)));
    }
    // Step limit reached: the remaining interval may contain a contact.
    MovingContact rest = contact_at(now);
    rest.t_hi = 1;
    return rest;
  }

  MovingContact at_start() const {
    MovingContact out = contact_at(moment(0));
    out.t_hi = 0;
    out.certain = true;
    return out;
  }

 private:
  HullMoment moment(double t) const {
    HullMoment m;
    m.t = t;
    const double s = 1 - t;
    for (size_t i = 0; i < size_t(n_); ++i) m.corner[i] = s * start_[i] + t * end_[i];
    const auto& c = m.corner;
    Vec3 normal;
    std::array<Vec3, 3> edges;
    size_t edge_count;
    if (n_ == 3) {
      edges = {c[0] - c[1], c[1] - c[2], c[2] - c[0]};
      edge_count = 3;
      const TrianglePoint near = closest_on_triangle(Vec3::Zero(), c[0], c[1], c[2]);
      for (int k = 0; k < 3; ++k) m.weights[k] = near.barycentric[k];
      normal = edges[0].cross(edges[1]);
    } else {
      edges = {c[2] - c[0], c[0] - c[1], Vec3::Zero()};
      edge_count = 2;
      const SegmentPair near = closest_segment_segment(c[0], c[2], Vec3::Zero(), edges[1]);
      m.weights = {(1 - near.s) * (1 - near.t), (1 - near.s) * near.t, near.s * (1 - near.t),
                   near.s * near.t};
      normal = edges[0].cross(edges[1]);
    }
    std::array<double, 3> square;
    size_t longest = 0;
    for (size_t i = 0; i < edge_count; ++i) {
      square[i] = edges[i].squaredNorm();
      if (square[i] > square[longest]) longest = i;
    }
    Vec3 nearest = Vec3::Zero();
    for (size_t i = 0; i < size_t(n_); ++i) nearest += m.weights[int(i)] * c[i];
    m.distance = nearest.norm();
    // The nearest points of features that nearly touch have few correct digits: directions that
    // must be perpendicular to an edge are made so.
    for (size_t i = 0; i < edge_count; ++i) {
      const double along = nearest.dot(edges[i]);
      if (along * along <= 256 * rounding_ * rounding_ * square[i])
        remove_along(edges[i], square[i], nearest);
    }
    remove_along(edges[longest], square[longest], normal);
    m.direction[0] = unit_or_zero(nearest);
    m.direction[1] = unit_or_zero(normal);
    if (m.direction[1].dot(c[0]) < 0) m.direction[1] = -m.direction[1];
    for (size_t k = 0; k < 2; ++k) m.margin[k] = least(m.direction[k], m);
    return m;
  }

  double least(const Vec3& w, const HullMoment& m) const {
    double out = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < size_t(n_); ++i) out = std::min(out, w.dot(m.corner[i]));
    return out;
  }

  /// Whether [a.t, b.t] is proven free of contact. The separating direction is passed on to b.
  bool free_between(const HullMoment& a, HullMoment& b) const {
    const size_t first = size_t(a.best()), last = size_t(b.best());
    if (b.margin[last] > needed_ && turning(a, a.direction[first], b, b.direction[last]))
      return true;
    for (size_t k = 0; k < 2; ++k) {
      if (constant(a, b, a.direction[k]) || constant(a, b, b.direction[k])) return true;
      if (k != first || k != last) {
        if (a.margin[k] > needed_ && b.margin[k] > needed_ &&
            turning(a, a.direction[k], b, b.direction[k])) {
          return true;
        }
      }
    }
    // When the nearest feature changes at a corner, neither end's direction separates throughout,
    // but the mean of the two may.
    return constant(a, b, unit_or_zero(a.direction[0] + b.direction[0]));
  }

  bool constant(const HullMoment& a, HullMoment& b, const Vec3& w) const {
    const double at_b = least(w, b);
    if (!(at_b > needed_) || !(least(w, a) > needed_)) return false;
    if (at_b > b.margin[size_t(b.best())]) {
      b.direction[size_t(b.best())] = w;
      b.margin[size_t(b.best())] = at_b;
    }
    return true;
  }

  /// Proof by the middle Bernstein coefficients for a direction that turns from wa to wb.
  bool turning(const HullMoment& a, const Vec3& wa, const HullMoment& b, const Vec3& wb) const {
    for (size_t i = 0; i < size_t(n_); ++i) {
      if (!(0.5 * (wa.dot(b.corner[i]) + wb.dot(a.corner[i])) > needed_)) return false;
    }
    return true;
  }

  /// The length of time for which the best constant direction separates.
  double sure_step(const HullMoment& m) const {
    double out = 0;
    for (const Vec3& w : m.direction) {
      double step = 2;
      for (size_t i = 0; i < size_t(n_); ++i) {
        const double room = w.dot(m.corner[i]) - needed_, rate = -w.dot(end_[i] - start_[i]);
        if (!(room > 0)) step = 0;
        if (rate > 0) step = std::min(step, room / rate);
      }
      out = std::max(out, step);
    }
    return out;
  }

  /// A time slightly before the nearest points would meet at their present velocity; with `way` -1,
  /// back in time.
  double towards_contact(const HullMoment& m, double way = 1) const {
    const int k = m.best();
    Vec3 speed = Vec3::Zero();
    for (size_t i = 0; i < size_t(n_); ++i) speed += m.weights[int(i)] * (end_[i] - start_[i]);
    const double rate = -way * m.direction[size_t(k)].dot(speed);
    const double room = m.margin[size_t(k)] - needed_;
    if (!(rate > 0) || room > 2 * rate) return 1;
    const double step = room / rate;
    return step * (1 - std::clamp(2 * step, 1e-4, 0.05));
  }

  MovingContact contact_at(const HullMoment& m) const {
    MovingContact out;
    out.t_lo = m.t;
    if (n_ == 3) {
      out.parameters = {m.weights[1], m.weights[2]};
    } else {
      out.parameters = {m.weights[2] + m.weights[3], m.weights[1] + m.weights[3]};
    }
    const Vec3& w = m.direction[size_t(m.best())];
    if (m.margin[size_t(m.best())] > 0) {
      out.normal = -w;
    } else {  // touching: the common normal, opposed to the approach; otherwise any direction
      Vec3 n = m.direction[1], speed = Vec3::Zero();
      for (size_t i = 0; i < size_t(n_); ++i) speed += m.weights[int(i)] * (end_[i] - start_[i]);
      if (n.isZero()) n = unit_or_zero(speed);
      if (n.isZero()) n = Vec3::UnitY();
      out.normal = n.dot(speed) < 0 ? Vec3(-n) : n;
    }
    return out;
  }

  /// Nothing is proven free from `m` on. Determines with growing steps how long that lasts.
  MovingContact in_doubt(const HullMoment& m) const {
    MovingContact out = contact_at(m);
    const auto surely_within = [&](const HullMoment& at) {
      return at.distance + 2 * rounding_ <= separation_;
    };
    if (surely_within(m)) {
      out.t_hi = m.t;
      out.certain = true;
      return out;
    }
    const auto surely_apart = [&](const HullMoment& at) {
      return at.margin[size_t(at.best())] > needed_ + 2 * rounding_;
    };
    double doubtful = m.t;
    for (double step = std::clamp(4 * towards_contact(m), 0x1p-42, 1e-8);;
         step = std::min((step < 0x1p-10 ? 16 : 4) * step, step + 0x1p-4)) {
      out.t_hi = std::min(1.0, m.t + step);
      const HullMoment later = moment(out.t_hi);
      if (surely_within(later)) {
        out.certain = true;
        return out;
      }
      if (surely_apart(later)) {
        out.t_hi = part_after(doubtful, later, surely_apart);
        return out;
      }
      if (!(out.t_hi < 1)) return out;
      doubtful = out.t_hi;
    }
  }

  /// The time, to 1e-10, from which the two are certainly apart; between `doubtful`, when they are
  /// not, and `apart`. Steps back by the speed at which the nearest points separate, and bisects
  /// where this does not help.
  template <class SurelyApart>
  double part_after(double doubtful, HullMoment apart, const SurelyApart& surely_apart) const {
    constexpr double known = 1e-10;
    constexpr int most_steps_back = 16;
    bool halve = false;
    for (int k = 0; apart.t - doubtful > known; ++k) {
      const double gap = apart.t - doubtful;
      double back = 0.5 * gap;
      if (!halve && k < most_steps_back)
        back = std::clamp(towards_contact(apart, -1), 0.75 * known, gap - 0.25 * known);
      const HullMoment m = moment(apart.t - back);
      halve = !surely_apart(m);
      if (halve) {
        doubtful = m.t;
      } else {
        apart = m;
      }
    }
    return apart.t;
  }

  std::array<Vec3, 4> start_, end_;
  int n_;
  double separation_;
  double rounding_ = 0;  ///< of the product of any direction and corner
  double needed_ = 0;    ///< what a computed product must exceed to be certainly positive
};

}  // namespace

MovingHull::MovingHull(const MovingPoint& vertex, const MovingTriangle& face) : corners(3) {
  for (size_t i = 0; i < 3; ++i) {
    start[i] = vertex.start - face[i].start;
    end[i] = vertex.end - face[i].end;
  }
}

MovingHull::MovingHull(const MovingEdge& a, const MovingEdge& b) : corners(4) {
  for (size_t i = 0; i < 2; ++i) {
    for (size_t j = 0; j < 2; ++j) {
      start[2 * i + j] = a[i].start - b[j].start;
      end[2 * i + j] = a[i].end - b[j].end;
    }
  }
}

MovingContact contact_at_start(const MovingHull& hull) {
  return HullMarch(hull, 0).at_start();
}

std::optional<MovingContact> march(const MovingHull& hull, double separation, double from) {
  return HullMarch(hull, separation).run(from);
}

}  // namespace tumble
