#pragma once
#include "engine/collision/field_pairs/field_sample.hpp"
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <vector>

namespace tumble {

/// Which features of a surface are tested against a field.
enum class FieldSearch : uint8_t { corners, corners_and_edges };

/// Contacts of a triangulated surface with a field, in the field's frame, in which `S` is placed:
/// active corners within `margin` by the field, the lowest points along active edges, and, for
/// corners where the gradient points past an edge of the field's mesh, the nearest point inward on
/// the face that lies on the field. Normals point out of the field; keys are those of corners and
/// edges. Returns a lower bound on the distance of the two [m], at most `margin` if anything may be
/// near.
///
/// Everything within reach is visited, by the surface's tree: a part is discarded only if the field
/// at one point, less its error and the size of the part, exceeds the margin, since a distance
/// function has Lipschitz constant 1 (Macklin et al., "Local optimization for robust signed
/// distance field collision", 2020, start from every element likewise).
double surface_in_field(const PlacedSurface& S, const DistanceField& field, double margin,
                        FieldSearch search, std::vector<FeatureContact>& contacts);

/// Whether no edge at a vertex rises along `inward` (unit, in the frame that S is placed in) by
/// more than `sine` times its own length.
bool sticks_out_along(const PlacedSurface& S, uint32_t vertex, const Vec3& inward, double sine);

}  // namespace tumble
