#pragma once
#include "engine/collision/convex_pairs/pair.hpp"

namespace tumble {

// Exact contacts of balls and capsules with each other and of balls with boxes.
void collide_sphere_sphere(const ShapePair& pair, std::vector<Manifold>& out);
void collide_sphere_capsule(const ShapePair& pair, std::vector<Manifold>& out);
void collide_capsule_capsule(const ShapePair& pair, std::vector<Manifold>& out);
void collide_sphere_box(const ShapePair& pair, std::vector<Manifold>& out);

}  // namespace tumble
