#pragma once
#include "engine/collision/manifold.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/contact/shape_pairs.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Manifolds of pairs of shapes of two bodies, of which one has several.
struct ShapeManifolds {
  std::vector<Manifold> manifolds;
  std::vector<ShapesOfPair> shapes;  ///< of each of them
};

/// Where shapes of one body share a face with those of another, their manifolds are one: what is
/// cut into pieces touches as the whole would. Manifolds of flat surfaces of one material whose
/// normals are within ten degrees, those of one mesh likewise (mesh_pairs/patches.hpp), share their
/// points, deepest manifolds first; the normal is the mean by depth. Of these points four carry the
/// contact (reduce_points); where others lie outside of the area that the four span, by more than a
/// tenth of the extent of all, four of these do as well, until none does: no leg on which a body
/// stands is left out. Others stay as they are.
///
/// Appends to `out`, with the first of the shapes that share each; gaps up to `margin` were asked
/// for [m]. `kept` is ContactQuery::kept.
void share_manifolds(const RigidBody& a, const RigidBody& b, const ShapeManifolds& found,
                     double margin, std::span<const uint64_t> kept, std::vector<Manifold>& out,
                     std::vector<ShapesOfPair>& shapes);

}  // namespace tumble
