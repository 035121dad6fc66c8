#pragma once
#include <cstdint>

/// Work of operations of this stepper, in the unit of WorkMeter; solvers of equations charge their
/// own. Measured once in nanoseconds and rounded: a price that is off by a factor of two changes
/// only when a tick exceeds its budget.
namespace tumble::prices {

/// Of each body: an evaluation of its equations of motion, and placing it where the last step had
/// it at some time.
inline constexpr uint64_t body = 400, place = 150;
/// Of each contact: evaluation of its gap and what follows from it; choice of its two surface
/// elements.
inline constexpr uint64_t gap = 150, contact = 1000;
/// Of two shapes or pieces: overhead, separation along a direction, nearest points, points of a
/// manifold.
inline constexpr uint64_t pair = 100, separation = 150, nearest_points = 1000, manifold = 1500;
/// In a bounding tree: testing one box or triangle; a search for the nearest triangle.
inline constexpr uint64_t box = 30, tree_search = 3000;

/// Of each body and step, including the search for events: a lower bound.
inline constexpr uint64_t step = 4000;

/// The unit of EventSettings::budget: an event of one body on a triangulated ground, including the
/// step up to it, which is computed again; between convex shapes it costs a tenth of that.
inline constexpr uint64_t event = 250000;
/// Tick in which the whole budget may be spent [s]. In shorter ones the budget is multiplied by the
/// square root of their ratio: there are more ticks in a second, but the cost of an event stays the
/// same.
inline constexpr double whole_tick = 1.0 / 60;
/// Number of particles with the budget of one body; fewer share that budget too.
inline constexpr uint64_t body_in_particles = 40;

}  // namespace tumble::prices
