#pragma once
#include "engine/collision/convex_pairs/pair.hpp"

namespace tumble {

/// One contact between two features before patches are made of them.
struct FeatureContact {
  Vec3 x;        ///< midway, pair frame [m]
  Vec3 normal;   ///< unit, from A to B, world axes
  double gap;    ///< [m]
  uint64_t key;  ///< of the two features
};

/// The cell of a direction on the octahedral map (Cigolle et al. 2014), y up: a number from 1 on
/// below patches_of_cell.
uint64_t direction_cell(const Vec3& n);
/// Added to Manifold::part where several patches are in one cell.
constexpr uint64_t patches_of_cell = 1024;

/// Gathers contacts with nearly the same normal into manifolds of at most four points each, deepest
/// first, and appends them. Each manifold's part is its normal's place on a coarse grid of world
/// directions, so that a thing at rest or rolling keeps it. Sorts `contacts`.
void emit_patches(const ShapePair& pair, std::vector<FeatureContact>& contacts,
                  std::vector<Manifold>& out);

}  // namespace tumble
