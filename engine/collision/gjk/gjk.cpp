#include "engine/collision/gjk/gjk.hpp"

#include "engine/collision/gjk/simplex_side.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// In units of the scale.
constexpr double touching = 1e-14;          ///< distances that cannot be told from contact
constexpr double bounds_met = 1e-13;        ///< difference of the bounds at which the search ends
constexpr double bounds_allowed = 1e-12;    ///< largest difference of the bounds of a result
constexpr double support_rounding = 4e-15;  ///< error of the height of a support plane

enum class Step { onward, separated, intersecting, beyond, stuck };

/// A copy that is read number by number.
inline Plain3 one_by_one(const Plain3& p) {
  const double x = p.x, y = p.y, z = p.z;
  return {x, y, z};
}

inline void take(DifferencePoint& to, const DifferencePoint& p) {
  to.w = one_by_one(p.w), to.a = one_by_one(p.a), to.b = one_by_one(p.b);
  to.vertex_a = p.vertex_a, to.vertex_b = p.vertex_b;
}

Step after(Reduction r) {
  return r == Reduction::inside    ? Step::intersecting
         : r == Reduction::unclear ? Step::stuck
                                   : Step::onward;
}

/// The places of a simplex that hold its current corners, the oldest first.
struct Order {
  int place[4];
  int count = 0;
  unsigned used = 0;

  void put(int i) {
    place[count++] = i;
    used |= 1u << i;
  }
  void take(const SimplexSide& s) {
    count = s.count;
    used = 0;
    for (int k = 0; k < count; ++k) {
      place[k] = s.corner[k];
      used |= 1u << place[k];
    }
  }
  /// One of three corners or fewer is free.
  int free_place() const { return __builtin_ctz(~used); }
};

class Search {
 public:
  template <class Scan>
  Search(const PlacedCore& A, const PlacedCore& B, const GjkOptions& options, GjkResult& r, Scan s)
      : options_(options), r_(r), difference_(A, B, s) {
    scale_ = difference_.scale();
    tolerance_ = bounds_met * scale_;
    tolerance2_ = tolerance_ * tolerance_;
    tiny2_ = touching * scale_ * (touching * scale_);
    const double farthest = options.max_distance + support_rounding * scale_;
    farthest2_ = farthest * farthest;
  }

  template <class Scan>
  void run() {
    Step step = run_fast<Scan>();
    // weights that miss the nearest point are those of a sliver, whose nearest point is in doubt
    // too
    if (step == Step::stuck || !weigh()) step = go_on_precisely();
    write(step);
  }

 private:
  template <class Scan>
  Step run_fast();
  [[gnu::noinline]] Step recall(const Simplex& earlier);
  Plain3 first_direction() const;
  bool holds(const Order& order, const Plain3& w) const;
  Step reduce_fast(const Plain3& a, int place, Order& order, NearestPoint& next);
  void gather(const Order& order);
  [[gnu::noinline]] Step go_on_precisely();
  Step advance_precisely();
  /// Evaluates the support plane through w.
  [[gnu::always_inline]] inline Step judge(const NearestPoint& near, const Plain3& w);
  /// Whether the bounds are close enough for a result if the search can go no further: curved
  /// shapes come so close in double precision, where their simplices have become too small.
  /// `vv` is the square of the upper bound.
  bool bounds_suffice(double vv) const {
    return vv - plane_ <= bounds_allowed * scale_ * std::sqrt(vv);
  }
  bool weigh() {
    Simplex& s = r_.simplex;
    return weigh_in_double(s, s.count == 4 ? Plain3{0, 0, 0} : one_by_one(near_.v), tolerance_);
  }
  void write(Step step);

  const GjkOptions& options_;
  GjkResult& r_;
  Difference difference_;
  double scale_, tolerance_, tolerance2_, tiny2_, farthest2_;
  NearestPoint near_;
  DifferencePoint points_[4];  ///< of the fast search, in arbitrary order
  double plane_ = 0;           ///< height of the last support plane times |v| [m^2]
};

/// The opposite of the first search direction, in the role of a nearest point.
inline Plain3 Search::first_direction() const {
  const Vec3& given = options_.initial_direction;
  const Plain3 d = given == Vec3::Zero() ? -difference_.centre() : difference_.direction_in(given);
  return d == Plain3{0, 0, 0} ? Plain3{1, 0, 0} : d;
}

/// Starts from the vertices of an earlier simplex.
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
  if (plane_ * std::abs(plane_) > farthest2_ * near.vv) return Step::beyond;
  const double between = near.vv - plane_;
  // one branch for both
  const bool met = (between <= options_.relative_tolerance * near.vv) |
                   (between * between <= tolerance2_ * near.vv);
  return met ? Step::separated : Step::onward;
}

/// The search in double precision. All in one function and by value, so that intermediate results
/// stay in registers: a vector that is stored number by number and loaded in pairs stalls the
/// processor. For the same reason corners stay at their place in memory, and only the list of
/// current ones changes.
template <class Scan>
Step Search::run_fast() {
  Simplex& s = r_.simplex;
  NearestPoint near{{0, 0, 0}, 0, {0, 0, 0}, 0};
  if (options_.start && options_.start->count > 0) {
    const Step step = recall(*options_.start);
    if (step != Step::onward) return step;
  }
  Order order, before;
  if (s.count > 0) {
    near.take(near_);
    for (int i = 0; i < s.count; ++i) take(points_[i], s.points[size_t(i)]), order.put(i);
  } else {
    near.along = -first_direction();
  }
  const int most = options_.max_iterations / 2;
  int iterations = 0;
  Step step = Step::onward;
  do {
    const int place = order.free_place();
    const DifferencePoint p = difference_.support_against<Scan>(near.along);
    const Plain3 w = p.w;
    take(points_[place], p);
    NearestPoint next;
    if (order.count == 0) {
      order.put(place);
      next = {w, w.squared(), w, 0};
    } else {
      step = judge(near, w);
      if (step == Step::onward && (++iterations > most || holds(order, w))) step = Step::stuck;
      if (step != Step::onward) break;
      before = order;
      step = reduce_fast(w, place, order, next);
      if (step == Step::onward && !(next.vv < near.vv)) step = Step::stuck;
      if (step == Step::stuck && bounds_suffice(near.vv)) order = before;
      if (step != Step::onward) break;
    }
    near = next;
    if (near.vv <= tiny2_) step = Step::intersecting;
  } while (step == Step::onward);
  r_.iterations = iterations;
  near_.take(near);
  gather(order);
  return step == Step::stuck && bounds_suffice(near.vv) ? Step::separated : step;
}

inline bool Search::holds(const Order& order, const Plain3& w) const {
  for (int i = 0; i < order.count; ++i)
    if (points_[order.place[i]].w == w) return true;
  return false;
}

/// `a`, at `place`, is the newest corner. If the result is unclear or inside, all corners stay.
inline Step Search::reduce_fast(const Plain3& a, int place, Order& order, NearestPoint& next) {
  const auto corner = [&](int k) { return one_by_one(points_[order.place[k]].w); };
  SimplexSide side;
  if (order.count == 1) {
    on_segment(a, place, corner(0), order.place[0], side);
  } else if (order.count == 2) {
    const Plain3 b = corner(1), c = corner(0);
    on_triangle(a, place, b, order.place[1], c, order.place[0], (b - a).cross(c - a), side);
  } else {
    const int all[4] = {order.place[0], order.place[1], order.place[2], place};
    const Reduction r = on_tetrahedron(a, corner(2), corner(1), corner(0), side);
    if (r != Reduction::outside) {
      order.put(place);
      return after(r);
    }
    for (int k = 0; k < side.count; ++k) side.corner[k] = all[side.corner[k]];
  }
  order.take(side);
  next = side.at;
  return Step::onward;
}

/// Moves the current corners to the front, in their order.
inline void Search::gather(const Order& order) {
  Simplex& s = r_.simplex;
  s.count = order.count;
  for (int i = 0; i < order.count; ++i) {
    take(s.points[size_t(i)], points_[order.place[i]]);
  }
}

Step Search::advance_precisely() {
  if (near_.vv <= tiny2_) return Step::intersecting;
  Simplex& s = r_.simplex;
  DifferencePoint& p = s.points[size_t(s.count)];
  p = difference_.support_against<ScanByTwo>(near_.along);
  const Step step = judge(near_, p.w);
  if (step != Step::onward) return step;
  // after the bounds are set: those of an earlier v would be too close to each other
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
  return step == Step::stuck && bounds_suffice(near_.vv) ? Step::separated : step;
}

void Search::write(Step step) {
  Simplex& s = r_.simplex;
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

template <class Scan>
inline void search(const PlacedCore& A, const PlacedCore& B, const GjkOptions& options,
                   GjkResult& r) {
  Search(A, B, options, r, Scan{}).run<Scan>();
}

[[gnu::flatten]] void search_by_two(const PlacedCore& A, const PlacedCore& B,
                                    const GjkOptions& options, GjkResult& r) {
  search<ScanByTwo>(A, B, options, r);
}

#if defined(__x86_64__)
[[gnu::target("avx"), gnu::flatten]] void search_by_four(const PlacedCore& A, const PlacedCore& B,
                                                         const GjkOptions& options, GjkResult& r) {
  search<ScanByFour>(A, B, options, r);
}
const auto search_fast = __builtin_cpu_supports("avx") ? search_by_four : search_by_two;
#else
const auto search_fast = search_by_two;
#endif

}  // namespace

GjkResult gjk(const PlacedCore& A, const PlacedCore& B, const GjkOptions& options) {
  GjkResult r;
  search_fast(A, B, options, r);
  return r;
}

}  // namespace tumble
