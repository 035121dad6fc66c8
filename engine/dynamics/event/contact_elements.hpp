#pragma once
#include "engine/dynamics/event/event_contact.hpp"

#include <vector>

namespace tumble {

/// Lies along a plane, if it touches one.
bool is_straight(const SurfaceElement& element);

/// Where a corner meets a corner, an edge or a rim, or edges meet along each other, any normal
/// between their faces would do: that of the pair and the material point of B do for a moment.
void choose_tangent(EventContact& contact, const RigidBody& a, const RigidBody& b, const Vec3& on_a,
                    const Vec3& on_b, const Vec3& normal);
/// The elements of one manifold point. Faces are planes only where the other side has a corner, an
/// edge or something round on them: of two faces the one without corners there is the plane.
void choose_elements(EventContact& contact, const RigidBody& a, const RigidBody& b,
                     const Vec3& on_a, const Vec3& on_b, const Vec3& normal);

/// A rim that rolls on a face has one element; other points of its manifold on the same circle go.
/// Of the contacts from the `first` on.
void drop_rim_points(std::vector<EventContact>& contacts, size_t first);
/// Whether a rim lies flat on a face, where no point of it is furthest out.
bool lies_flat(const EventContact& contact, const ElementPlace& place,
               std::span<const RigidBody> bodies);

}  // namespace tumble
