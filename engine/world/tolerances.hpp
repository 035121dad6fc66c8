#pragma once

/// The constants of this folder that no setting gives, with unit and reason.
namespace tumble::tolerances {

/// A run counts as broken when its energy exceeds the energy supplied by this factor [-]: no error
/// of a working method is so large, and unbounded growth passes it soon.
inline constexpr double energy_growth = 1000;
/// Energy below that of everything moving at this speed, which is faster than anything falls in a
/// room, is not tested [m/s]. A world that begins at rest in the plane of the origin has no energy
/// to compare with.
inline constexpr double no_energy_speed = 100;
/// Standard gravity, by which weights are judged where gravity itself follows a course [m/s2].
inline constexpr double earth_gravity = 9.80665;
/// Rounding error of an energy that is summed over many bodies, relative [-].
inline constexpr double energy_digits = 1e-14;

/// A certificate calls a contact sliding if its force is within this distance of the surface of its
/// friction cone, relative to the cone's radius [-].
inline constexpr double certified_sliding = 1e-6;
/// Depth that contacts of the event stepper must not exceed, beyond the depth at which they began
/// [m].
inline constexpr double most_event_depth = 1e-5;
/// A body deeper in another one than this share of its least thickness has been dragged there: no
/// impact goes so deep [-].
inline constexpr double dragged_depth = 0.25;
/// Depth up to which overlap of bodies at rest is normal, for any size [m].
inline constexpr double ordinary_overlap = 1e-3;

/// Distance that counts as touching in the search for the time of a particle's first contact [m].
inline constexpr double meeting_distance = 1e-6;
/// A particle collides only if it approaches faster than this [m/s].
inline constexpr double approaching_speed = 1e-9;

/// A net of springs is solved in sub-steps if the ends of a spring move relative to each other by
/// more than this share of its length in a tick [-]: its direction at the start is then of no use
/// at the end.
inline constexpr double passed_of_length = 0.5;
/// The same if straight paths over the tick would stretch a spring by more than this share of the
/// energy of its rotation [-].
inline constexpr double stretched_by_turning = 0.01;

/// Largest ratio of the spacings of fluids that are solved together [-]: the kernel, whose support
/// follows from the mean volume of all, then covers at least one and a half spacings of each.
inline constexpr double most_spacing_ratio = 1.25;
/// A fluid wakes a sleeping body whose velocity it would change in a tick by more than this share
/// of what gravity would [-].
inline constexpr double waking_push = 0.1;

}  // namespace tumble::tolerances
