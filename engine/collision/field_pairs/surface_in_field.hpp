#pragma once
#include "engine/collision/field_pairs/field_sample.hpp"
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <vector>

namespace tumble {

/// Which parts of a surface look for a field.
enum class FieldSearch : uint8_t { corners, corners_and_edges };

/// Contacts of a triangulated surface with a field, in the field's frame, in which `S` is placed:
/// active corners that the field says are within `margin`, the lowest places along active edges,
/// and, for corners where the field leads past the edge of its mesh, the nearest place on the way
/// into the face that lies on the field. Normals point out of the field; keys are those of corners
/// and edges. Returns a bound that the two are sure to be apart [m], at most `margin` where
/// anything may be near.
///
/// Everything within reach is visited, by the surface's tree: a part is left out only where the
/// field at one point, less its error and the size of the part, is above the margin, for a distance
/// changes by no more than one goes (Macklin et al., "Local optimization for robust signed distance
/// field collision", 2020, start from every element alike).
double surface_in_field(const PlacedSurface& S, const DistanceField& field, double margin,
                        FieldSearch search, std::vector<FeatureContact>& contacts);

/// Whether the surface around a vertex reaches no farther than `sine` of the way along `inward`
/// (unit, frame that S is placed in).
bool sticks_out_along(const PlacedSurface& S, uint32_t vertex, const Vec3& inward, double sine);

}  // namespace tumble
