#include "engine/collision/convex_pairs/polyhedron_pairs.hpp"

#include "engine/collision/convex_pairs/convex_convex.hpp"
#include "engine/collision/v_clip/v_clip.hpp"

namespace tumble {

void collide_polyhedra(const ShapePair& pair, std::vector<Manifold>& out) {
  const ConvexShape &a = *pair.a.convex(), &b = *pair.b.convex();
  const VoronoiPolyhedron *va = a.voronoi(), *vb = b.voronoi();
  if (!va || !vb) {
    collide_convex_convex(pair, out);
    return;
  }
  VClipOptions options;
  options.start = pair.start;
  const VClipResult near =
      v_clip(PlacedPolyhedron(*va, pair.pose_a), PlacedPolyhedron(*vb, pair.pose_b), options);
  const size_t first = out.size();
  if (near.state == VClipState::separated || near.state == VClipState::touching) {
    if (near.distance > pair.margin) return;
    const CoreContact contact{near.normal, near.distance, near.a, near.b, true, false};
    ManifoldBuilder points;
    contact_points(PlacedCore(a, pair.pose_a.q, pair.pose_a.x),
                   PlacedCore(b, pair.pose_b.q, pair.pose_b.x), contact, pair.margin, points);
    emit(pair, points, contact.normal, 0, out);
  } else {
    collide_convex_convex(pair, out);
  }
  for (size_t i = first; i < out.size(); ++i) out[i].closest = near.features;
}

}  // namespace tumble
