#pragma once

/// The constants by which the side of an open surface is decided, with unit and reason.
namespace tumble::tolerances {

/// A point is behind a feature if the cosine of the angle between the way to it and the feature's
/// normal reversed is at least this [-], so within 60 degrees: beside the rim of a surface it is on
/// neither side.
inline constexpr double least_cosine = 0.5;

/// A triangle that crosses a plane is behind it if it reaches this many times as far behind it as
/// in front [-]: one that is pressed in from the front crosses by less than a fifth of its height.
inline constexpr double mostly_ratio = 4;

/// A centre is behind if it is by this many times as much as the shape reaches in front [-]: a
/// shape that has come from the front has more of it there.
inline constexpr double clear_ratio = 2;

/// Distances up to here are rounding [sizes of both surfaces]: of coordinates of a unit that were
/// turned once, 1e-16 each, with room for vertices that a file gives in single precision.
inline constexpr double touching_share = 1e-9;

}  // namespace tumble::tolerances
