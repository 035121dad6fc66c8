#pragma once
#include "engine/collision/contact_query.hpp"
#include "engine/collision/manifold.hpp"
#include "engine/collision/shape.hpp"
#include "engine/math/types.hpp"

#include <string_view>
#include <vector>

namespace tumble {

/// Appends the manifolds of two shapes at the given poses: every region where the gap is at most
/// `query.margin`, separated or penetrating. The same call gives the same bits; exchanging the
/// shapes gives the same contacts with opposite normals. Two half-spaces give nothing, and neither
/// does a pose that is not finite. Thread-safe; shapes whose bounding spheres are far apart cost
/// next to nothing.
using NarrowPhase = void (*)(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                             const ContactQuery& query, std::vector<Manifold>& out);

/// An algorithm for closest points of convex shapes, by name; meshes and special pairs are the same
/// for all.
struct NarrowPhaseEntry {
  std::string_view name;
  NarrowPhase collide;
};

/// "gjk" and "v_clip" (boxes and hulls by V-Clip, the rest as under "gjk").
const std::vector<NarrowPhaseEntry>& all_narrow_phases();

/// The narrow phase "gjk".
void collide(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
             const ContactQuery& query, std::vector<Manifold>& out);

}  // namespace tumble
