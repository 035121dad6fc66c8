#include "engine/collision/continuous/swept_triangles.hpp"

#include "engine/collision/continuous/earliest_contact.hpp"
#include "engine/collision/continuous/moving_facet.hpp"
#include "engine/collision/triangle_core.hpp"
#include "engine/core/stop.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// With more pairs than this the first half of the interval is searched first, as long as that has
/// fewer.
constexpr size_t many_pairs = 48;

/// Whether the core of a shape is a point or a segment along y.
bool round_core(const Shape& s) {
  const ConvexShape* c = s.convex();
  if (!c || c->view().kind != CoreView::Kind::box) return false;
  return c->rounding() > 0 && c->view().half.x() == 0 && c->view().half.z() == 0;
}

/// The point or segment of a ball or capsule.
MovingFacet core_facet(const Shape& s, const Motion& m) {
  const double radius = s.convex()->rounding();
  if (s.is_ball()) return {m, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, 1, radius};
  const Vec3 half = s.convex()->view().half;
  return {m, {Vec3(-half), half, half}, 2, radius};
}

MovingFacet triangle_facet(const MeshSurface& s, uint32_t t, const Motion& m) {
  return {m, {s.mesh->corner(t, 0), s.mesh->corner(t, 1), s.mesh->corner(t, 2)}, 3};
}

/// Two triangles that may meet in a part of the interval, but not before `earliest`.
struct SweptCandidate {
  TriangleIds ids;
  double earliest;
};

/// A is a surface or has a round core, B is a surface.
class TriangleSearch {
 public:
  explicit TriangleSearch(const MovingPair& p)
      : p_(p),
        a_(round_core(p.a) ? nullptr : &p.surface_a()),
        b_(p.surface_b()),
        found_(p.t1()),
        speed_(p.speed()) {}

  TimeOfContact run() {
    if (p_.a.convex()) skip_triangles_in_reach_of_solid();
    const double size = a_ ? 0.25 * std::min(a_->size, b_.size) : p_.a.bounding_radius();
    const IntervalParts parts(p_.t0(), p_.t1(), speed_ * (p_.t1() - p_.t0()), size, 512);
    for (int k = 0; k < parts.count && !found_.found() && !stop_requested(); ++k) {
      search(parts.from(k), parts.to(k), k == 0, std::numeric_limits<size_t>::max());
    }
    return found_.answer();
  }

 private:
  MovingFacet facet_a(uint32_t t) const {
    return a_ ? triangle_facet(*a_, t, p_.motion_a) : core_facet(p_.a, p_.motion_a);
  }
  MovingFacet facet_b(uint32_t t) const { return triangle_facet(b_, t, p_.motion_b); }

  void skip_triangles_in_reach_of_solid() {
    const double t0 = p_.t0();
    const Pose pa = p_.motion_a.pose(t0), pb = p_.motion_b.pose(t0);
    const MovingCore core = p_.core_a();
    std::vector<uint32_t> near;
    b_.tree->overlap(p_.a.bounds(pb.inverse() * pa).inflated(2 * p_.tolerance), near);
    for (const uint32_t t : near) {
      const auto c = corners(*b_.mesh, t);
      const TriangleCore triangle(c[0], c[1], c[2]);
      const Nearest n = nearest_cores(core, pa, {triangle, p_.motion_b, 0, 0}, pb, 2 * p_.tolerance,
                                      p_.tolerance);
      found_.add_iterations(1);
      if (n.distance > p_.tolerance) continue;
      TimeOfContact touching;
      touching.status = TimeOfContactStatus::initially_overlapping;
      set_nearest(touching, n, t0);
      touching.high = p_.t1();
      found_.offer(touching, 0, t, true);
      solid_skips_.push_back(t);
    }
  }

  void search(double from, double to, bool first_part, size_t pairs_before) {
    to = std::min(to, found_.time());
    if (!(from <= to) || stop_requested()) return;
    find_pairs(from, to);
    const size_t count = pairs_.size();
    if (count > many_pairs && double(count) < 0.8 * double(pairs_before)) {
      const double middle = from + 0.5 * (to - from);
      if (middle > from && middle < to) {
        search(from, middle, first_part, count);
        if (!found_.found()) search(middle, to, false, count);
        return;
      }
    }
    order_pairs(from, to);
    for (const SweptCandidate& c : candidates_) {
      const double end = std::min(to, found_.time());
      if (c.earliest > end || stop_requested()) break;
      const MovingFacet fa = facet_a(c.ids.a), fb = facet_b(c.ids.b);
      const TimeOfContact met = facet_contact(fa, fb, from, end, p_.tolerance);
      if (found_.offer(met, c.ids.a, c.ids.b, first_part)) pair_skips_.push_back(c.ids);
    }
    std::sort(pair_skips_.begin(), pair_skips_.end());
  }

  /// Finds the pairs whose swept bounds meet between two times, in the frame of the first mesh.
  void find_pairs(double from, double to) {
    pairs_.clear();
    const Pose pa = p_.motion_a.pose(from), pb = p_.motion_b.pose(from);
    if (a_) {
      SweptQuery q;
      q.other_pose = pa.inverse() * pb;
      q.own = bound(p_.motion_a, pa, from, to);
      q.other_motion = bound(p_.motion_b, pa, from, to);
      q.margin = 2 * p_.tolerance;
      a_->tree->swept_pairs(*b_.tree, q, pairs_);
    } else {
      const double middle = 0.5 * (from + to),
                   reach = 0.5 * speed_ * (to - from) + 2 * p_.tolerance;
      const Pose relative = p_.motion_b.pose(middle).inverse() * p_.motion_a.pose(middle);
      triangles_.clear();
      b_.tree->overlap(p_.a.bounds(relative).inflated(reach), triangles_);
      for (const uint32_t t : triangles_) pairs_.push_back({0, t});
    }
    std::erase_if(pairs_, [&](TriangleIds ids) {
      return std::binary_search(solid_skips_.begin(), solid_skips_.end(), ids.b) ||
             std::binary_search(pair_skips_.begin(), pair_skips_.end(), ids);
    });
  }
  static MotionBound bound(const Motion& m, const Pose& frame, double from, double to) {
    MotionBound out;
    out.translation = frame.inverse_direction((to - from) * m.velocity);
    out.centre = frame.inverse_point(m.carrier(from).x);
    out.angle = m.omega.norm() * (to - from);
    return out;
  }
  void order_pairs(double from, double to) {
    candidates_.clear();
    for (const TriangleIds ids : pairs_) {
      const double earliest =
          facets_apart_until(facet_a(ids.a), facet_b(ids.b), from, p_.tolerance);
      if (earliest <= to) candidates_.push_back({ids, earliest});
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const auto& x, const auto& y) {
      return x.earliest != y.earliest ? x.earliest < y.earliest : x.ids < y.ids;
    });
  }

  const MovingPair& p_;
  const MeshSurface* a_;  ///< null for a round core
  const MeshSurface& b_;
  EarliestContact found_;
  double speed_;
  std::vector<TriangleIds> pairs_;
  std::vector<uint32_t> triangles_;
  std::vector<SweptCandidate> candidates_;
  /// Of B, within the tolerance of the solid A from the start; ascending.
  std::vector<uint32_t> solid_skips_;
  std::vector<TriangleIds> pair_skips_;  ///< within the tolerance from the start; ascending
};

}  // namespace

bool triangles_apply(const MovingPair& p) {
  if (p.half_space()) return false;
  const auto facets = [](const Shape& s) { return s.polyhedral() || round_core(s); };
  return facets(p.a) && facets(p.b) && (p.a.polyhedral() || p.b.polyhedral());
}

TimeOfContact find_by_triangles(const MovingPair& p) {
  if (p.both_convex()) {
    ConvexDistance distance(p.core_a(), p.core_b(), p.tolerance);
    const Nearest now = distance.at(p.t0(), 2 * p.tolerance);
    if (now.distance <= p.tolerance) {
      TimeOfContact r;
      r.status = TimeOfContactStatus::initially_overlapping;
      r.iterations = 1;
      set_contact(r, distance, now, p.t0(), p.t1(), p.tolerance);
      return r;
    }
    if (round_core(p.b)) {
      return exchanged(
          find_by_triangles({p.b, p.motion_b, p.a, p.motion_a, p.tolerance, p.options}));
    }
  }
  return TriangleSearch(p).run();
}

}  // namespace tumble
