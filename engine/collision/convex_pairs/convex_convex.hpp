#pragma once
#include "engine/collision/convex_pairs/pair.hpp"
#include "engine/collision/gjk/gjk.hpp"

namespace tumble {

/// Any two convex shapes: GJK, or EPA where the cores overlap, gives normal and gap; clipping the
/// supporting faces against each other gives the points.
void collide_convex_convex(const ShapePair& pair, std::vector<Manifold>& out);

/// Where two placed cores are nearest, or deepest in each other, with their radii of rounding.
struct CoreContact {
  Vec3 normal = Vec3::UnitY();              ///< unit, from A to B
  double gap = 0;                           ///< [m]
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();  ///< nearest or deepest points of the cores
  bool within = false;                      ///< gap <= margin
  bool overlap = false;                     ///< the cores overlap
  double lower_bound = 0;                   ///< lower bound of the gap, if the cores are apart [m]
};
CoreContact nearest_or_deepest(const PlacedCore& A, const PlacedCore& B, double margin);

/// Adds the points of a contact along `normal`: those of the clipped faces, and the nearest points
/// themselves if no corner is as near.
void contact_points(const PlacedCore& A, const PlacedCore& B, const CoreContact& contact,
                    double margin, ManifoldBuilder& points);

}  // namespace tumble
