#pragma once
#include <cstdint>

/// The numbers of this room that no setting gives: unit, reason, and source where there is one.
namespace tumble::tolerances {

// Order.

/// Edge of the cells along whose curve grains are stored [largest radii]: a few grains in each, and
/// more than how far apart two may be that a part of a tick can bring together.
inline constexpr double grain_cell = 4;

// Contacts.

/// Contacts are foreseen so far beyond what the approach of the part closes [radii]: what rests
/// keeps its contacts while it trembles.
inline constexpr double grain_margin = 0.02;
/// Nothing is foreseen farther off [radii]: a plane foreseen at one point holds up what would pass
/// beside it.
inline constexpr double grain_foresight = 1.0;
/// Two grains may approach by no more in a part of a tick [least radii]: by half a radius more than
/// is foreseen, so that they never pass each other's middle unseen.
inline constexpr double grain_part = 1.5;
/// Parts of a tick at most [-]: grains that are faster pass into heaps, and are pushed out.
inline constexpr int most_grain_parts = 4;

/// How far about itself a grain that no shape is near asks how near they are [radii]: it need not
/// ask again while it and they have moved by less.
inline constexpr double grain_clearance = 16;

// Response.

/// Share of the overlap that a sub-step works off by moving apart what overlaps [-]: more makes
/// heaps tremble.
inline constexpr double grain_push_out = 0.3;
/// Overlap that is left [radii], so that what rests keeps pressing.
inline constexpr double grain_slop = 1e-3;
/// Speed at which a body leaves grains that it overlaps, by overlap [1/s]: gone in five ticks.
inline constexpr double grain_lift = 12;

// Paths.

/// A grain that passes by more than this relative to what is near looks along its path [radii].
inline constexpr double grain_looks = 0.5;
/// What is looked along is a ball of this size, so that what rests touches nothing [radii].
inline constexpr double grain_core = 0.8;
/// How near counts as met [radii].
inline constexpr double grain_met = 1e-3;

// Rest.

/// Time over which the mean motion of a grain is taken [s].
inline constexpr double grain_watch = 0.1;
/// What moves by so many times the speed of rest wakes what it touches, and does not rest [-].
inline constexpr double grain_wakes = 6;

}  // namespace tumble::tolerances
