#pragma once
#include "engine/world/state.hpp"

namespace tumble {

// Targets of motors, and kinematic bodies, that follow a prescribed course over time (TimeCourse).
// They are functions of the definitions and of the time only, and are evaluated anew for each tick.

/// For the coming tick: sets the targets of motors, and the velocities that bring kinematic bodies
/// to their prescribed poses at its end. Wakes bodies that a motor begins to move. Error: a course
/// has no finite value; then nothing is changed.
Status follow_courses(WorldState& state);

/// Sets only the targets of motors, for queries between ticks; a target without a finite value is
/// left as it was.
void set_motor_targets(WorldState& state);

/// How bodies on courses move through the coming tick, given that their velocities are its means:
/// each velocity changes linearly in time, with a limited slope estimated from the mean velocities
/// of this tick and its neighbours, so that it jumps only where the course does. Bodies at rest are
/// left out.
std::vector<CourseMotion> course_motions(const WorldState& state);
/// The velocities of all bodies on courses as they are now, and their present accelerations.
std::vector<CourseMotion> course_changes(const WorldState& state);

/// Places a body that has a course at its prescribed pose of now, and adds it to `on_course`.
void begin_course(WorldState& state, uint32_t slot);
/// Removes the course of a body, which then moves by its velocity.
void end_course(WorldState& state, uint32_t slot);
/// Rebuilds the list of bodies on courses from the definitions.
void find_courses(WorldState& state);
bool has_courses(const WorldState& state);

}  // namespace tumble
