#pragma once
#include <cstdint>

/// What the stepper's own work costs, in the unit of WorkMeter; what solves systems of equations
/// says so itself. Measured once, in nanoseconds, and rounded: a price that is off by a factor of
/// two moves the moment at which a tick is too dear, and nothing else.
namespace tumble::prices {

/// Of a body and an evaluation of its equations of motion, and of a body that is put where the last
/// step had it at a time.
inline constexpr uint64_t body = 400, place = 150;
/// Of a contact: its gap and what follows from that; its two surface elements.
inline constexpr uint64_t gap = 150, contact = 1000;
/// Of two shapes or pieces: what they cost at all, how far they are apart along a direction, their
/// nearest points, and the points of a manifold.
inline constexpr uint64_t pair = 100, separation = 150, nearest_points = 1000, manifold = 1500;
/// In a tree of boxes: one of these, or a triangle; and a search for the nearest.
inline constexpr uint64_t box = 30, tree_search = 3000;

/// Of a body and a step, with the looks for its first event: at least.
inline constexpr uint64_t step = 4000;

/// What EventSettings::budget counts: an event of one body on a ground of triangles, the step up to
/// it computed again with all that this needs; between convex shapes it is a tenth of that.
inline constexpr uint64_t event = 250000;
/// A tick in which all of the budget may be spent [s]; in shorter ones less, by the root of their
/// share in it: a second has more of them, but events take what they take.
inline constexpr double whole_tick = 1.0 / 60;
/// Particles that may cost as much as one body; so may fewer.
inline constexpr uint64_t body_in_particles = 40;

}  // namespace tumble::prices
