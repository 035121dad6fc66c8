#include "engine/collision/gjk/gjk.hpp"

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
    Step step = start();
    while (step == Step::onward) step = advance();
    if (step == Step::stuck) step = go_on_precisely();
    write(step);
  }

 private:
  Step start();
  Step advance();
  Step go_on_precisely();
  Step advance_precisely();
  /// What the support plane through w says.
  Step judge(const Plain3& w);
  void write(Step step);

  const GjkOptions& options_;
  GjkResult& r_;
  Difference difference_;
  double scale_, tolerance_, tiny2_, farthest_;
  NearestPoint near_;
  double plane_ = 0;  ///< height of the last support plane times |v| [m^2]
};

Step Search::start() {
  Simplex& s = r_.simplex;
  if (options_.start && options_.start->count > 0) {
    DifferencePoint p;
    for (int i = 0; i < std::min(options_.start->count, 4); ++i) {
      const DifferencePoint& old = options_.start->points[size_t(i)];
      if (difference_.recall(old.vertex_a, old.vertex_b, p) && !s.contains(p.w)) s.add(p);
    }
  }
  if (s.count > 1) {
    const Step step = after(reduce_from_all_sides(s, near_));
    if (step != Step::onward) return step;
  } else {
    if (s.count == 0) {
      const Vec3& given = options_.initial_direction;
      Plain3 d = given.isZero() ? -difference_.centre() : difference_.direction_in(given);
      if (d == Plain3{0, 0, 0}) d.x = 1;
      difference_.support(d, s.points[0]);
      s.count = 1;
    }
    reduce(s, near_);
  }
  return near_.vv <= tiny2_ ? Step::intersecting : Step::onward;
}

Step Search::judge(const Plain3& w) {
  plane_ = near_.v.dot(w);
  if (plane_ > 0 && plane_ * plane_ > farthest_ * farthest_ * near_.vv) return Step::beyond;
  const double between = near_.vv - plane_;
  if (between <= options_.relative_tolerance * near_.vv ||
      between * between <= tolerance_ * tolerance_ * near_.vv)
    return Step::separated;
  return Step::onward;
}

Step Search::advance() {
  if (++r_.iterations > options_.max_iterations / 2) return Step::stuck;
  Simplex& s = r_.simplex;
  DifferencePoint& p = s.points[size_t(s.count)];
  difference_.support(-near_.along, p);
  Step step = judge(p.w);
  if (step == Step::separated && !difference_.always_certain()) {
    difference_.settle(-near_.along, p);
    step = judge(p.w);
  }
  if (step != Step::onward) return step;
  if (s.contains(p.w)) return Step::stuck;
  ++s.count;
  NearestPoint next;
  step = after(reduce(s, next));
  if (step != Step::onward) return step;
  if (!(next.vv < near_.vv)) return Step::stuck;
  near_ = next;
  return near_.vv <= tiny2_ ? Step::intersecting : Step::onward;
}

Step Search::advance_precisely() {
  if (near_.vv <= tiny2_) return Step::intersecting;
  Simplex& s = r_.simplex;
  DifferencePoint& p = s.points[size_t(s.count)];
  difference_.support(-near_.along, p);
  difference_.settle(-near_.along, p);
  const Step step = judge(p.w);
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
  if (!r_.precise) set_weights(s, s.count == 4 ? Plain3{0, 0, 0} : near_.v, tolerance_);
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
