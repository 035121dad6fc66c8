#pragma once
#include "engine/collision/convex_pairs/pair.hpp"

namespace tumble {

/// A contact between two features, before contacts are grouped to manifolds.
struct FeatureContact {
  Vec3 x;        ///< midway, pair frame [m]
  Vec3 normal;   ///< unit, from A to B, world axes
  double gap;    ///< [m]
  uint64_t key;  ///< of the two features
};

/// The cell of a direction on the octahedral map (Cigolle et al. 2014), y up: an index from 1 on,
/// less than patches_of_cell.
uint64_t direction_cell(const Vec3& n);
/// Added to Manifold::part for further manifolds in one cell.
constexpr uint64_t patches_of_cell = 1024;

/// Groups contacts with nearly the same normal into manifolds of at most four points each, deepest
/// first, and appends them. The part of a manifold is the cell of its normal on a coarse grid of
/// world directions, so that it persists for bodies at rest or rolling. Sorts `contacts`.
void emit_patches(const ShapePair& pair, std::vector<FeatureContact>& contacts,
                  std::vector<Manifold>& out);

}  // namespace tumble
