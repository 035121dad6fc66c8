#pragma once
#include "engine/dynamics/event/event_contact.hpp"

#include <vector>

namespace tumble {

/// Whether an element touches a plane along a whole line.
bool is_straight(const SurfaceElement& element);

/// Where a corner meets a corner, an edge or a rim, or two edges are parallel, the normal is not
/// unique. Then the plane across `normal` through the point on A, and the material point of B,
/// stand in for one step.
void choose_tangent(EventContact& contact, const RigidBody& a, const RigidBody& b, const Vec3& on_a,
                    const Vec3& on_b, const Vec3& normal);
/// Chooses the elements of one manifold point. A face is a plane only if the other side has a
/// corner, an edge or something round there: of two faces, the one without a corner at the point
/// becomes the plane.
void choose_elements(EventContact& contact, const RigidBody& a, const RigidBody& b,
                     const Vec3& on_a, const Vec3& on_b, const Vec3& normal);

/// Where a rim rolls on a face, one element represents all its contact; other manifold points on
/// the same circle are removed. Examines the contacts from `first` on.
void drop_rim_points(std::vector<EventContact>& contacts, size_t first);
/// Whether a rim lies flat on a face, so that no point of it is the furthest.
bool lies_flat(const EventContact& contact, const ElementPlace& place,
               std::span<const RigidBody> bodies);

}  // namespace tumble
