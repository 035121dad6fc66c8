#pragma once
#include "engine/collision/convex_pairs/pair.hpp"

namespace tumble {

/// Two boxes: separating axes, 6 face normals and 9 edge pairs (Gottschalk, Lin & Manocha 1996),
/// then clipping. An edge axis must be clearly better than the face axes to be chosen, so that
/// stacked boxes keep their face contacts from tick to tick.
void collide_box_box(const ShapePair& pair, std::vector<Manifold>& out);

}  // namespace tumble
