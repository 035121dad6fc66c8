#pragma once
#include "engine/collision/manifold.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/contact/shape_pairs.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Manifolds of pairs of shapes of two bodies, at least one of which has several shapes.
struct ShapeManifolds {
  std::vector<Manifold> manifolds;
  std::vector<ShapesOfPair> shapes;  ///< by manifold
};

/// Merges manifolds of neighbouring shapes into one, so that a body that is cut into pieces touches
/// as the whole would. Manifolds of planar surfaces of equal material whose normals are within ten
/// degrees share their points, deepest manifolds first, by the rule that also merges the patches of
/// one mesh (mesh_pairs/patches.hpp); the normal is the mean weighted by depth. Four of the points
/// carry the contact (reduce_points). While points lie outside of the polygon that the kept ones
/// span by more than a tenth of the extent of all points, four more are kept, so that every leg on
/// which a body stands has a contact. All other manifolds stay as they are.
///
/// Appends the manifolds to `out`, and to `shapes` the first pair of shapes of each. `margin` is
/// the gap up to which the narrow phase searched [m]; `kept` is ContactQuery::kept.
void share_manifolds(const RigidBody& a, const RigidBody& b, const ShapeManifolds& found,
                     double margin, std::span<const uint64_t> kept, std::vector<Manifold>& out,
                     std::vector<ShapesOfPair>& shapes);

}  // namespace tumble
