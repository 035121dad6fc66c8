#include "engine/dynamics/contact/exact/pair_gap.hpp"

#include "engine/collision/convex_pairs/convex_convex.hpp"
#include "engine/collision/gjk/epa.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double clearly_apart = 1e-3;  ///< of the size: the nearest points say the normal
constexpr double lift = 1e-2;           ///< of the size: how far B is moved apart
constexpr double same_normal = 1e-13;
constexpr int most_lifts = 12;

/// Furthest along n of a shape at a pose, relative to `origin`.
double reach_along(const Shape& s, const Pose& pose, const Vec3& origin, const Vec3& n) {
  const Vec3 local = pose.inverse_direction(n);
  const double at = n.dot(pose.x - origin);
  if (const ConvexShape* c = s.convex()) return at + local.dot(c->support(local)) + c->rounding();
  constexpr double across = 1e-12;
  const bool along = local.y() > 0 && local.x() * local.x() + local.z() * local.z() < across;
  return along ? at : std::numeric_limits<double>::infinity();
}

PairGap against_half_space(const Pose& plane, const ConvexShape& b, const Pose& pose_b,
                           double margin) {
  PairGap g;
  g.normal = plane.direction(Vec3::UnitY());
  const Vec3 low = pose_b.point(b.support(pose_b.inverse_direction(-g.normal)));
  g.gap = g.normal.dot(low - plane.x) - b.rounding();
  g.near = g.gap <= margin;
  g.on_b = low - b.rounding() * g.normal;
  g.on_a = g.on_b - g.gap * g.normal;
  return g;
}

/// Two cores in a frame at A.
struct CorePair {
  PlacedCore a, b;
  double size;  ///< of the smaller one [m]

  CorePair(const Shape& sa, const Pose& pa, const Shape& sb, const Pose& pb)
      : a(*sa.convex(), pa.q, Vec3::Zero()),
        b(*sb.convex(), pb.q, pb.x - pa.x),
        size(std::min(sa.bounding_radius(), sb.bounding_radius())) {}
  double separation(const Vec3& n) const { return n.dot(b.support(-n) - a.support(n)); }
  GjkResult apart(const Vec3& by) const {
    PlacedCore moved = b;
    moved.x += by;
    return gjk(a, moved);
  }
};

/// Climbs to the greatest separation near a direction.
void climb(const CorePair& cores, Vec3 n, CoreContact& best) {
  best.gap = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < most_lifts; ++k) {
    const double separation = cores.separation(n);
    const Vec3 by = (std::max(0.0, -separation) + lift * cores.size) * n;
    const GjkResult r = cores.apart(by);
    if (r.status != GjkStatus::separated) return;
    const double found = cores.separation(r.normal);
    const double turned = (r.normal - n).norm();
    if (found > best.gap) best = {r.normal, found, r.a, r.b - by, true, found < 0};
    if (turned <= same_normal || found < separation - 1e-15 * cores.size) return;
    n = r.normal;
  }
}

CoreContact core_gap(const CorePair& cores, double farthest, const Vec3& towards_b) {
  GjkOptions options;
  options.max_distance = farthest;
  options.initial_direction = towards_b;
  const GjkResult near = gjk(cores.a, cores.b, options);
  CoreContact best;
  best.gap = near.distance;
  if (near.status == GjkStatus::beyond) return best;
  const bool apart = near.status != GjkStatus::intersecting;
  if (apart && near.distance > clearly_apart * cores.size)
    return {near.normal, near.distance, near.a, near.b, true, false};
  best.gap = -std::numeric_limits<double>::infinity();
  // Touching: the last normal is a better start than the noise of touching points.
  if (!towards_b.isZero()) climb(cores, towards_b, best);
  if (!(best.gap > -clearly_apart * cores.size)) {
    const Vec3 start = apart ? near.normal : epa(cores.a, cores.b, near.simplex).normal;
    CoreContact other;
    climb(cores, start, other);
    if (other.gap > best.gap) best = other;
  }
  return best;
}

}  // namespace

double separation_along(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                        const Vec3& n) {
  return -reach_along(b, pose_b, pose_a.x, -n) - reach_along(a, pose_a, pose_a.x, n);
}

bool has_pair_gap(const Shape& a, const Shape& b) {
  const auto mesh = [](const Shape& s) { return s.type() == ShapeType::triangle_mesh; };
  return !mesh(a) && !mesh(b) && (a.convex() || b.convex());
}

PairGap pair_gap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                 double margin, const Vec3& towards_b) {
  if (!a.convex()) return against_half_space(pose_a, *b.convex(), pose_b, margin);
  if (!b.convex()) {
    PairGap g = against_half_space(pose_b, *a.convex(), pose_a, margin);
    g.normal = -g.normal;
    std::swap(g.on_a, g.on_b);
    return g;
  }
  PairGap g;
  const double ra = a.convex()->rounding(), rb = b.convex()->rounding();
  const double apart = (pose_b.x - pose_a.x).norm() - a.bounding_radius() - b.bounding_radius();
  g.gap = apart;
  if (apart > margin) return g;
  const CorePair cores(a, pose_a, b, pose_b);
  const CoreContact c = core_gap(cores, margin + ra + rb, towards_b);
  g.gap = c.gap - ra - rb;
  g.near = c.within && g.gap <= margin;
  if (!g.near) return g;
  g.normal = c.normal;
  g.on_a = pose_a.x + c.a + ra * c.normal;
  g.on_b = pose_a.x + c.b - rb * c.normal;
  return g;
}

void pair_manifolds(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    const ContactQuery& query, const PairGap& gap, NarrowPhase narrow_phase,
                    std::vector<Manifold>& out) {
  const size_t first = out.size();
  if (a.convex() && b.convex()) {
    const ShapePair pair(a, pose_a, b, pose_b, query);
    const PlacedCore A(*a.convex(), pose_a.q, pair.pose_a.x),
        B(*b.convex(), pose_b.q, pair.pose_b.x);
    const double ra = A.core->rounding(), rb = B.core->rounding();
    const CoreContact contact{gap.normal,
                              gap.gap,
                              gap.on_a - pair.origin - ra * gap.normal,
                              gap.on_b - pair.origin + rb * gap.normal,
                              true,
                              false};
    ManifoldBuilder points;
    contact_points(A, B, contact, query.margin, points);
    emit(pair, points, gap.normal, 0, out);
  } else {
    narrow_phase(a, pose_a, b, pose_b, query, out);
  }
  const double near = gap.gap + 1e-9 * std::min(a.bounding_radius(), b.bounding_radius());
  for (size_t i = first; i < out.size(); ++i)
    for (int k = 0; k < out[i].count; ++k)
      if (out[i].points[size_t(k)].gap <= near) return;
  Manifold& m = out.emplace_back();
  m.normal = gap.normal;
  m.part = second_manifold;
  m.count = 1;
  m.points[0] = {0.5 * (gap.on_a + gap.on_b), gap.gap, 0};
}

}  // namespace tumble
