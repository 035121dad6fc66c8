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

inline void take(DifferencePoint& to, const DifferencePoint& p) {
  to.w = one_by_one(p.w), to.a = one_by_one(p.a), to.b = one_by_one(p.b);
  to.vertex_a = p.vertex_a, to.vertex_b = p.vertex_b;
}

Step after(Reduction r) {
  return r == Reduction::inside    ? Step::intersecting
         : r == Reduction::unclear ? Step::stuck
                                   : Step::onward;
}

/// Which places of a simplex hold the corners that count, the oldest first.
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

/// What the search compares with.
struct Limits {
  double scale, tolerance, tolerance2, tiny2, farthest2, relative;

  Limits(const Difference& d, const GjkOptions& options)
      : scale(d.scale()),
        tolerance(bounds_met * scale),
        tolerance2(tolerance * tolerance),
        tiny2(touching * scale * (touching * scale)),
        relative(options.relative_tolerance) {
    const double farthest = options.max_distance + support_rounding * scale;
    farthest2 = farthest * farthest;
  }

  /// What the support plane through w says, whose height times |v| is `plane` [m^2].
  Step judge(double vv, double plane) const {
    if (plane * std::abs(plane) > farthest2 * vv) return Step::beyond;
    const double between = vv - plane;
    // one jump for both
    const bool met = (between <= relative * vv) | (between * between <= tolerance2 * vv);
    return met ? Step::separated : Step::onward;
  }
};

/// Where a search stands.
struct State {
  NearestPoint near;
  double plane = 0;  ///< height of the last support plane times |v| [m^2]
};

/// In double precision. No pointer to it leaves the function that runs it, so that what it holds
/// need not be in memory.
class Search {
 public:
  template <class Scan>
  Search(const PlacedCore& A, const PlacedCore& B, const GjkOptions& options, GjkResult& r, Scan s)
      : options_(options), r_(r), difference_(A, B, s), limits_(difference_, options) {}

  template <class Scan>
  void run(const PlacedCore& A, const PlacedCore& B);

 private:
  template <class Scan>
  Step run_fast(State& state);
  Step recall(const Simplex& earlier, NearestPoint& near);
  Plain3 first_direction() const;
  bool holds(const Order& order, const Plain3& w) const;
  Step reduce_fast(const Plain3& a, int place, Order& order, NearestPoint& next);
  void gather(const Order& order);
  void write(Step step, const State& state);

  const GjkOptions& options_;
  GjkResult& r_;
  Difference difference_;
  Limits limits_;
  DifferencePoint points_[4];  ///< in no order
};

/// The direction to look in first: opposite to it, so that it counts as a nearest point.
inline Plain3 Search::first_direction() const {
  const Vec3& given = options_.initial_direction;
  const Plain3 d = given == Vec3::Zero() ? -difference_.centre() : difference_.direction_in(given);
  return d == Plain3{0, 0, 0} ? Plain3{1, 0, 0} : d;
}

/// Takes up the vertices of an earlier simplex.
inline Step Search::recall(const Simplex& earlier, NearestPoint& near) {
  Simplex& s = r_.simplex;
  for (int i = 0; i < std::min(earlier.count, 4); ++i) {
    const DifferencePoint& old = earlier.points[size_t(i)];
    DifferencePoint& p = s.points[size_t(s.count)];
    if (difference_.recall(old.vertex_a, old.vertex_b, p) && !s.contains(p.w)) ++s.count;
  }
  if (s.count == 0) return Step::onward;
  NearestPoint found;
  const Step step = after(reduce_from_all_sides(s, found));
  near.take(found);
  if (step != Step::onward) return step;
  return near.vv <= limits_.tiny2 ? Step::intersecting : Step::onward;
}

/// All in one function and by value, so that what a step finds stays in registers: a vector that
/// goes through memory number by number, and comes back in pairs, makes the processor wait. For the
/// same reason corners stay where they were put down, and only the list of those that count
/// changes.
template <class Scan>
Step Search::run_fast(State& state) {
  Simplex& s = r_.simplex;
  NearestPoint near{{0, 0, 0}, 0, {0, 0, 0}, 0};
  if (options_.start && options_.start->count > 0) {
    const Step step = recall(*options_.start, near);
    if (step != Step::onward) {
      state.near = near;
      return step;
    }
  }
  Order order;
  if (s.count > 0) {
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
      if (++iterations > most) {
        step = Step::stuck;
        break;
      }
      state.plane = near.v.dot(w);
      step = limits_.judge(near.vv, state.plane);
      if (step == Step::onward && holds(order, w)) step = Step::stuck;
      if (step != Step::onward) break;
      step = reduce_fast(w, place, order, next);
      if (step == Step::onward && !(next.vv < near.vv)) step = Step::stuck;
      if (step != Step::onward) break;
    }
    near = next;
    if (near.vv <= limits_.tiny2) step = Step::intersecting;
  } while (step == Step::onward);
  r_.iterations = iterations;
  state.near = near;
  gather(order);
  return step;
}

inline bool Search::holds(const Order& order, const Plain3& w) const {
  for (int i = 0; i < order.count; ++i)
    if (points_[order.place[i]].w == w) return true;
  return false;
}

/// `a`, at `place`, is the newest corner. Unclear or inside, all corners stay.
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

/// The corners that count to the front, in their order.
inline void Search::gather(const Order& order) {
  Simplex& s = r_.simplex;
  s.count = order.count;
  for (int i = 0; i < order.count; ++i) {
    take(s.points[size_t(i)], points_[order.place[i]]);
  }
}

/// The search from where double precision did not do.
class PreciseSearch {
 public:
  PreciseSearch(const PlacedCore& A, const PlacedCore& B, const GjkOptions& options, GjkResult& r,
                State& state)
      : r_(r),
        state_(state),
        difference_(A, B),
        limits_(difference_, options),
        max_iterations_(options.max_iterations) {}

  Step run();

 private:
  Step advance();

  GjkResult& r_;
  State& state_;
  Difference difference_;
  Limits limits_;
  int max_iterations_;
};

Step PreciseSearch::advance() {
  NearestPoint& near = state_.near;
  if (near.vv <= limits_.tiny2) return Step::intersecting;
  Simplex& s = r_.simplex;
  DifferencePoint& p = s.points[size_t(s.count)];
  p = difference_.support(-near.along);
  state_.plane = near.v.dot(p.w);
  const Step step = limits_.judge(near.vv, state_.plane);
  if (step != Step::onward) return step;
  // after the bounds have been told: those of an earlier v would be too near to each other
  if (++r_.iterations > max_iterations_) return Step::stuck;
  if (s.contains(p.w)) return Step::stuck;
  ++s.count;
  const NearestPoint before = near;
  if (reduce_precisely(s, near) == Reduction::inside) return Step::intersecting;
  return (near.vv - before.vv) + (near.vv_rest - before.vv_rest) < 0 ? Step::onward : Step::stuck;
}

Step PreciseSearch::run() {
  r_.precise = true;
  if (reduce_precisely(r_.simplex, state_.near) == Reduction::inside) return Step::intersecting;
  Step step = Step::onward;
  while (step == Step::onward) step = advance();
  const double vv = state_.near.vv;
  if (step == Step::stuck && vv - state_.plane <= bounds_allowed * limits_.scale * std::sqrt(vv))
    return Step::separated;
  return step;
}

[[gnu::noinline]] Step go_on_precisely(const PlacedCore& A, const PlacedCore& B,
                                       const GjkOptions& options, GjkResult& r, State& state) {
  return PreciseSearch(A, B, options, r, state).run();
}

template <class Scan>
void Search::run(const PlacedCore& A, const PlacedCore& B) {
  State state;
  Step step = run_fast<Scan>(state);
  if (step == Step::stuck) {
    State precise = state;
    step = go_on_precisely(A, B, options_, r_, precise);
    state = precise;
  }
  write(step, state);
}

inline void Search::write(Step step, const State& state) {
  Simplex& s = r_.simplex;
  const NearestPoint& near = state.near;
  if (!r_.precise &&
      !weigh_in_double(s, s.count == 4 ? Plain3{0, 0, 0} : one_by_one(near.v), limits_.tolerance)) {
    NearestPoint same;
    reduce_precisely(s, same);
  }
  r_.a = difference_.point_out(s.nearest_a());
  r_.b = difference_.point_out(s.nearest_b());
  if (step == Step::intersecting) {
    r_.status = GjkStatus::intersecting;
    return;
  }
  const double length = std::sqrt(near.vv);
  r_.normal = difference_.direction_out(near.v * (-1 / length));
  r_.lower_bound = std::max(state.plane / length - support_rounding * limits_.scale, 0.0);
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
  Search(A, B, options, r, Scan{}).run<Scan>(A, B);
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
