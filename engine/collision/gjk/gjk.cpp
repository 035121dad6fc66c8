#include "engine/collision/gjk/gjk.hpp"

#include "engine/collision/gjk/simplex_side.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// In units of the scale.
constexpr double touching = 1e-14;          ///< distances that cannot be told from contact
constexpr double bounds_met = 1e-13;        ///< between the bounds, to end
constexpr double bounds_allowed = 1e-12;    ///< between the bounds, at worst
constexpr double support_rounding = 4e-15;  ///< of the height of a support plane

enum class Step { onward, separated, intersecting, beyond, stuck };

/// A copy that is read number by number.
inline Plain3 one_by_one(const Plain3& p) {
  const double x = p.x, y = p.y, z = p.z;
  return {x, y, z};
}

Step after(Reduction r) {
  return r == Reduction::inside    ? Step::intersecting
         : r == Reduction::unclear ? Step::stuck
                                   : Step::onward;
}

class Search {
 public:
  Search(const PlacedCore& A, const PlacedCore& B, const GjkOptions& options, GjkResult& r)
      : options_(options), r_(r), difference_(A, B) {
    scale_ = difference_.scale();
    tolerance_ = bounds_met * scale_;
    tiny2_ = touching * scale_ * (touching * scale_);
    farthest_ = options.max_distance + support_rounding * scale_;
  }

  void run() {
    Step step = run_fast();
    if (step == Step::stuck) step = go_on_precisely();
    write(step);
  }

 private:
  Step run_fast();
  Step recall(const Simplex& earlier);
  Plain3 first_direction() const;
  [[gnu::always_inline]] inline Step reduce_fast(const Plain3& a, NearestPoint& next);
  Step go_on_precisely();
  Step advance_precisely();
  /// What the support plane through w says.
  [[gnu::always_inline]] inline Step judge(const NearestPoint& near, const Plain3& w);
  void write(Step step);

  const GjkOptions& options_;
  GjkResult& r_;
  Difference difference_;
  double scale_, tolerance_, tiny2_, farthest_;
  NearestPoint near_;
  double plane_ = 0;  ///< height of the last support plane times |v| [m^2]
};

/// The direction to look in first: opposite to it, so that it counts as a nearest point.
inline Plain3 Search::first_direction() const {
  const Vec3& given = options_.initial_direction;
  const Plain3 d = given.isZero() ? -difference_.centre() : difference_.direction_in(given);
  return d == Plain3{0, 0, 0} ? Plain3{1, 0, 0} : d;
}

/// Takes up the vertices of an earlier simplex.
Step Search::recall(const Simplex& earlier) {
  Simplex& s = r_.simplex;
  DifferencePoint p;
  for (int i = 0; i < std::min(earlier.count, 4); ++i) {
    const DifferencePoint& old = earlier.points[size_t(i)];
    if (difference_.recall(old.vertex_a, old.vertex_b, p) && !s.contains(p.w)) s.add(p);
  }
  if (s.count == 0) return Step::onward;
  const Step step = after(reduce_from_all_sides(s, near_));
  if (step != Step::onward) return step;
  return near_.vv <= tiny2_ ? Step::intersecting : Step::onward;
}

inline Step Search::judge(const NearestPoint& near, const Plain3& w) {
  plane_ = near.v.dot(w);
  if (plane_ > 0 && plane_ * plane_ > farthest_ * farthest_ * near.vv) return Step::beyond;
  const double between = near.vv - plane_;
  if (between <= options_.relative_tolerance * near.vv ||
      between * between <= tolerance_ * tolerance_ * near.vv)
    return Step::separated;
  return Step::onward;
}

/// In double precision. All in one function and by value, so that what a step finds stays in
/// registers: a vector that goes through memory number by number, and comes back in pairs, makes
/// the processor wait.
Step Search::run_fast() {
  Simplex& s = r_.simplex;
  NearestPoint near{{0, 0, 0}, 0, {0, 0, 0}, 0};
  if (options_.start && options_.start->count > 0) {
    const Step step = recall(*options_.start);
    if (step != Step::onward) return step;
  }
  if (s.count > 0) {
    near.take(near_);
  } else {
    near.along = -first_direction();
  }
  for (;;) {
    DifferencePoint p;
    difference_.support(-near.along, p);
    NearestPoint next;
    if (s.count == 0) {
      s.add(p);
      next = {p.w, p.w.squared(), p.w, 0};
    } else {
      Step step = ++r_.iterations > options_.max_iterations / 2 ? Step::stuck : judge(near, p.w);
      if (step == Step::onward && s.contains(p.w)) step = Step::stuck;
      if (step == Step::onward) {
        s.add(p);
        step = reduce_fast(p.w, next);
      }
      if (step == Step::onward && !(next.vv < near.vv)) step = Step::stuck;
      if (step != Step::onward) {
        near_.take(near);
        return step;
      }
    }
    near = next;
    if (near.vv <= tiny2_) {
      near_.take(near);
      return Step::intersecting;
    }
  }
}

/// `a` is the newest corner.
inline Step Search::reduce_fast(const Plain3& a, NearestPoint& next) {
  Simplex& s = r_.simplex;
  if (s.count == 4) {
    NearestPoint found;
    const Step step = after(reduce(s, found));
    next.take(found);
    return step;
  }
  SimplexSide side;
  const Plain3 b = one_by_one(s.points[size_t(s.count - 2)].w);
  if (s.count == 2) {
    on_segment(a, 1, b, 0, side);
  } else {
    const Plain3 c = one_by_one(s.points[0].w);
    on_triangle(a, 2, b, 1, c, 0, (b - a).cross(c - a), side);
  }
  s.keep_side(side.corner, side.count);
  next = side.at;
  return Step::onward;
}

Step Search::advance_precisely() {
  if (near_.vv <= tiny2_) return Step::intersecting;
  Simplex& s = r_.simplex;
  DifferencePoint& p = s.points[size_t(s.count)];
  difference_.support(-near_.along, p);
  const Step step = judge(near_, p.w);
  if (step != Step::onward) return step;
  // after the bounds have been told: those of an earlier v would be too near to each other
  if (++r_.iterations > options_.max_iterations) return Step::stuck;
  if (s.contains(p.w)) return Step::stuck;
  ++s.count;
  const NearestPoint before = near_;
  if (reduce_precisely(s, near_) == Reduction::inside) return Step::intersecting;
  return (near_.vv - before.vv) + (near_.vv_rest - before.vv_rest) < 0 ? Step::onward : Step::stuck;
}

Step Search::go_on_precisely() {
  r_.precise = true;
  if (reduce_precisely(r_.simplex, near_) == Reduction::inside) return Step::intersecting;
  Step step = Step::onward;
  while (step == Step::onward) step = advance_precisely();
  if (step == Step::stuck && near_.vv - plane_ <= bounds_allowed * scale_ * std::sqrt(near_.vv))
    return Step::separated;
  return step;
}

void Search::write(Step step) {
  Simplex& s = r_.simplex;
  if (!r_.precise) set_weights(s, s.count == 4 ? Plain3{0, 0, 0} : one_by_one(near_.v), tolerance_);
  r_.a = difference_.point_out(s.nearest_a());
  r_.b = difference_.point_out(s.nearest_b());
  if (step == Step::intersecting) {
    r_.status = GjkStatus::intersecting;
    return;
  }
  const double length = std::sqrt(near_.vv);
  r_.normal = difference_.direction_out(near_.v * (-1 / length));
  r_.lower_bound = std::max(plane_ / length - support_rounding * scale_, 0.0);
  r_.distance = std::max(length, r_.lower_bound);
  if (step == Step::beyond) {
    r_.status = GjkStatus::beyond;
    r_.distance = r_.lower_bound;
  } else if (step == Step::stuck) {
    r_.status = GjkStatus::max_iterations;
  }
}

}  // namespace

GjkResult gjk(const PlacedCore& A, const PlacedCore& B, const GjkOptions& options) {
  GjkResult r;
  Search(A, B, options, r).run();
  return r;
}

}  // namespace tumble
