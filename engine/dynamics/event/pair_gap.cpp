#include "engine/dynamics/event/pair_gap.hpp"

#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/core_gap.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tumble {
namespace {

/// The point furthest along n in the shape's frame; for a mesh, its furthest vertex.
Vec3 support(const Shape& s, const Vec3& n) {
  if (const ConvexShape* c = s.convex()) return c->support(n);
  const std::vector<Vec3>& vertices = s.polyhedral()->surface().mesh->vertices;
  charge_work(vertices.size());
  return *std::max_element(vertices.begin(), vertices.end(),
                           [&](const Vec3& p, const Vec3& q) { return n.dot(p) < n.dot(q); });
}

double rounding(const Shape& s) {
  return s.convex() ? s.convex()->rounding() : 0;
}

/// Support height along n of a shape at a pose, relative to `origin` [m].
double reach_along(const Shape& s, const Pose& pose, const Vec3& origin, const Vec3& n) {
  const Vec3 local = pose.inverse_direction(n);
  const double at = n.dot(pose.x - origin);
  if (!s.is_half_space()) return at + local.dot(support(s, local)) + rounding(s);
  const bool along =
      local.y() > 0 && local.x() * local.x() + local.z() * local.z() < tolerances::along_normal2;
  return along ? at : std::numeric_limits<double>::infinity();
}

PairGap against_half_space(const Pose& plane, const Shape& b, const Pose& pose_b, double margin) {
  PairGap g;
  g.normal = plane.direction(Vec3::UnitY());
  const Vec3 low = pose_b.point(support(b, pose_b.inverse_direction(-g.normal)));
  g.gap = g.normal.dot(low - plane.x) - rounding(b);
  g.near = g.gap <= margin;
  g.on_b = low - rounding(b) * g.normal;
  g.on_a = g.on_b - g.gap * g.normal;
  return g;
}

/// Gap of a ball (B) and a shape with a closed form of nearest points. None where the ball's centre
/// is inside of A or nearly so: there the normal of the last time counts, not the nearest way out.
/// Two balls with coinciding centres are separated along y.
std::optional<PairGap> to_ball(const Shape& a, const Pose& pose_a, const Shape& ball,
                               const Vec3& centre, double margin) {
  const auto nearest = a.convex()->nearest(pose_a.inverse_point(centre));
  const double radius = ball.def().radius;
  const bool out = nearest && nearest->distance > tolerances::clearly_out_of_radius * radius;
  if (!out && !a.is_ball()) return std::nullopt;
  PairGap g;
  g.gap = nearest->distance - radius;
  g.near = g.gap <= margin;
  g.normal = pose_a.direction(nearest->normal);
  g.on_a = pose_a.point(nearest->x);
  g.on_b = centre - radius * g.normal;
  return g;
}

PairGap exchanged(PairGap g) {
  g.normal = -g.normal;
  std::swap(g.on_a, g.on_b);
  return g;
}

}  // namespace

double separation_along(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                        const Vec3& n) {
  charge_work(prices::separation);
  return -reach_along(b, pose_b, pose_a.x, -n) - reach_along(a, pose_a, pose_a.x, n);
}

bool has_pair_gap(const Shape& a, const Shape& b) {
  return (a.convex() && b.convex()) || a.is_half_space() != b.is_half_space();
}

PairGap pair_gap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                 double margin, const Vec3& towards_b) {
  charge_work(prices::separation);
  if (a.is_half_space()) return against_half_space(pose_a, b, pose_b, margin);
  if (b.is_half_space()) return exchanged(against_half_space(pose_b, a, pose_a, margin));
  PairGap g;
  const double ra = a.convex()->rounding(), rb = b.convex()->rounding();
  const double apart = (pose_b.x - pose_a.x).norm() - a.bounding_radius() - b.bounding_radius();
  g.gap = apart;
  if (apart > margin) return g;
  if (b.is_ball()) {
    if (const auto closed = to_ball(a, pose_a, b, pose_b.x, margin)) return *closed;
  } else if (a.is_ball()) {
    if (const auto closed = to_ball(b, pose_b, a, pose_a.x, margin)) return exchanged(*closed);
  }
  const CorePair cores{PlacedCore(*a.convex(), pose_a.q, Vec3::Zero()),
                       PlacedCore(*b.convex(), pose_b.q, pose_b.x - pose_a.x),
                       std::min(a.bounding_radius(), b.bounding_radius())};
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
  charge_work(prices::manifold);
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
  const double near =
      gap.gap + tolerances::nearest_of_size * std::min(a.bounding_radius(), b.bounding_radius());
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
