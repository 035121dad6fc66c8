#pragma once

/// The numbers of this room that no setting gives: unit and reason.
namespace tumble::tolerances {

/// Energy may exceed by this factor what came into the world before the run counts as broken [-]:
/// no error of a method that works is so large, and what grows without bound passes it soon.
inline constexpr double energy_growth = 1000;
/// Energy that is not told from none: all that moves at this speed, faster than anything falls in a
/// room [m/s]. A world that begins at rest in the plane of the origin has no energy to compare
/// with.
inline constexpr double no_energy_speed = 100;
/// Rounding of an energy that many bodies add up to, relative [-].
inline constexpr double energy_digits = 1e-14;

/// A contact slides, for a certificate, whose force is within this of the surface of its cone, as a
/// share of the cone's radius [-].
inline constexpr double certified_sliding = 1e-6;
/// Depth that the event stepper promises contacts not to pass, beyond the depth that was accepted
/// when they began [m].
inline constexpr double most_event_depth = 1e-5;
/// No impact goes so deep, as a part of the least thickness of the body [-]: it has been dragged.
inline constexpr double dragged_depth = 0.25;
/// What contacts of bodies at rest may overlap by, of any size [m].
inline constexpr double ordinary_overlap = 1e-3;

/// How near counts as touching when the first time of a particle's contact is sought [m].
inline constexpr double meeting_distance = 1e-6;
/// A particle that comes nearer faster than this collides [m/s].
inline constexpr double approaching_speed = 1e-9;

/// A net of springs takes sub-steps where the ends of one pass by more than this share of its
/// length in a tick [-]: the direction that it has at the start says nothing of the end.
inline constexpr double passed_of_length = 0.5;
/// And where straight paths in a tick would stretch one by more than this share of the energy of
/// its turning [-].
inline constexpr double stretched_by_turning = 0.01;

/// Largest ratio of the spacings of fluids that see each other [-]: the kernel, which goes by the
/// mean volume of all, then reaches no fewer than one and a half spacings of any.
inline constexpr double most_spacing_ratio = 1.25;
/// Pushes of a fluid that would give a sleeping body this share of the speed that it falls to in a
/// tick wake it [-].
inline constexpr double waking_push = 0.1;

}  // namespace tumble::tolerances
