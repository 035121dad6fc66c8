#pragma once
#include "engine/collision/convex_pairs/pair.hpp"

namespace tumble {

/// Two boxes or hulls: V-Clip gives the closest features, starting from those of the last query if
/// there was one, with normal and gap; clipping the supporting faces against each other gives the
/// points. Penetration, which V-Clip does not measure, and hulls without Voronoi planes are left to
/// GJK and EPA.
void collide_polyhedra(const ShapePair& pair, std::vector<Manifold>& out);

}  // namespace tumble
