#include "engine/collision/convex_pairs/convex_convex.hpp"

#include "engine/collision/convex_pairs/face_clipping.hpp"
#include "engine/collision/feature_key.hpp"
#include "engine/collision/gjk/epa.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// The points of two overlapping cores that touch last when B moves out along the contact's normal:
/// the nearest points after a move by a little more than the depth.
void touching_points(const PlacedCore& A, PlacedCore B, double scale, CoreContact& c,
                     double depth) {
  const Vec3 out = (depth + 0.01 * scale) * c.normal;
  B.x += out;
  const GjkResult r = gjk(A, B);
  if (r.status != GjkStatus::separated) return;
  c.a = r.a;
  c.b = r.b - out;
}

}  // namespace

CoreContact nearest_or_deepest(const PlacedCore& A, const PlacedCore& B, double margin) {
  const double rounding = A.core->rounding() + B.core->rounding();
  GjkOptions options;
  options.max_distance = margin + rounding;
  const GjkResult near = gjk(A, B, options);
  CoreContact c;
  c.lower_bound = near.lower_bound - rounding;
  if (near.status == GjkStatus::beyond) return c;
  if (near.status != GjkStatus::intersecting) {
    c.normal = near.normal;
    c.gap = near.distance - rounding;
    c.a = near.a;
    c.b = near.b;
  } else {
    const EpaResult deep = epa(A, B, near.simplex);
    c.normal = deep.normal;
    c.gap = -deep.depth - rounding;
    c.a = deep.a;
    c.b = deep.b;
    c.overlap = true;
    // For grazing curved surfaces the polytope ends in slivers, whose weights are dominated by
    // rounding.
    const double scale = std::max((A.support(deep.normal) - A.centre()).norm(),
                                  (B.support(-deep.normal) - B.centre()).norm());
    if (((c.a - c.b) - deep.depth * deep.normal).norm() > 1e-2 * deep.depth + 1e-6 * scale)
      touching_points(A, B, scale, c, deep.depth);
  }
  c.within = c.gap <= margin;
  return c;
}

void contact_points(const PlacedCore& A, const PlacedCore& B, const CoreContact& contact,
                    double margin, ManifoldBuilder& points) {
  const Vec3& n = contact.normal;
  const double ra = A.core->rounding(), rb = B.core->rounding();
  SupportingFace fa, fb;
  A.supporting_face(n, fa);
  B.supporting_face(-n, fb);
  clip_faces(fa, fb, n, ra, rb, margin, points);
  double least = std::numeric_limits<double>::infinity(), reach = 0;
  for (const ManifoldPoint& p : points.points()) {
    least = std::min(least, p.gap);
    reach = std::max(reach, (p.x_world - points.points()[0].x_world).norm());
  }
  if (least <= contact.gap + 1e-3 * reach + 1e-9) return;
  const Vec3 on_a = contact.a + ra * n, on_b = contact.b - rb * n;
  points.add(0.5 * (on_a + on_b), contact.gap, feature_key(FeaturePair::closest, 0, 0));
}

void collide_convex_convex(const ShapePair& pair, std::vector<Manifold>& out) {
  const PlacedCore A(*pair.a.convex(), pair.pose_a.q, pair.pose_a.x);
  const PlacedCore B(*pair.b.convex(), pair.pose_b.q, pair.pose_b.x);
  const CoreContact contact = nearest_or_deepest(A, B, pair.margin);
  if (!contact.within) {
    pair.found_apart(contact.lower_bound, 0);
    return;
  }
  ManifoldBuilder points;
  contact_points(A, B, contact, pair.margin, points);
  emit(pair, points, contact.normal, 0, out);
}

}  // namespace tumble
