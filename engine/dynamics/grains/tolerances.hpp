#pragma once
#include <cstddef>
#include <cstdint>

/// Constants of this folder that are no settings: unit, reason, and source where there is one.
namespace tumble::tolerances {

// Order.

/// Edge of the cells along whose space-filling curve grains are stored [largest radii]: a few
/// grains in each, and more than the distance of two grains that may meet in a part of a tick.
inline constexpr double grain_cell = 4;

// Contacts.

/// Gap within which contacts are foreseen, beyond the approach in the part [radii]: resting grains
/// keep their contacts while they tremble.
inline constexpr double grain_margin = 0.02;
/// Greatest gap at which contacts of two grains are foreseen [radii]: with it and the margin, their
/// distance is the edge of a cell. Their direction follows them from sub-step to sub-step.
inline constexpr double grain_foresight = 1.95;
/// The same for shapes: a contact plane, which stays where it is for a part, would stop grains that
/// pass beside a farther point of a shape.
inline constexpr double grain_shape_foresight = 1.0;
/// Greatest approach of two grains in a part of a tick [least radii]: half a radius more than is
/// foreseen, so that they never pass each other's centre unseen.
inline constexpr double grain_part = 2.45;
/// Number of grains next to each other along the curve whose mean velocity says how fast many
/// grains are [-]: the least that a single fast grain does not decide.
inline constexpr size_t grain_group = 4;
/// Greatest approach of two such groups in a part of a tick [least radii]. It is less than that of
/// two grains, because collisions that follow from a first one are foreseen only from part to part:
/// where many grains are fast, many would overlap.
inline constexpr double grain_group_part = 1.5;
/// Most parts of a tick [-]: faster grains penetrate heaps, and are pushed out.
inline constexpr int most_grain_parts = 4;

/// Distance up to which a grain without a shape near it computes its clearance [radii]: it need not
/// do so again while grain and shapes have moved by less.
inline constexpr double grain_clearance = 16;

// Response.

/// Share of the overlap that is removed in a sub-step by moving grains apart [-]: a larger one
/// makes heaps tremble.
inline constexpr double grain_push_out = 0.3;
/// Overlap that is not corrected [radii], so that resting contacts keep pressing.
inline constexpr double grain_slop = 1e-3;
/// Speed at which a body leaves grains that it overlaps, per overlap [1/s]: gone in five ticks.
inline constexpr double grain_lift = 12;

// Paths.

/// A grain that moves farther than this relative to shapes near it is swept along its path [radii].
inline constexpr double grain_looks = 0.5;
/// Radius of the ball that is swept [radii], less than that of the grain, so that resting grains
/// touch nothing.
inline constexpr double grain_core = 0.8;
/// Distance at which the swept ball has met a shape [radii].
inline constexpr double grain_met = 1e-3;

// Rest.

/// Time over which the motion of a grain is averaged [s].
inline constexpr double grain_watch = 0.1;
/// A body or grain faster than this multiple of the speed of rest wakes what it touches, and does
/// not rest [-].
inline constexpr double grain_wakes = 6;

}  // namespace tumble::tolerances
