#pragma once
#include "engine/world/state.hpp"

namespace tumble {

// What follows a course over time (TimeCourse): targets of motors, and kinematic bodies. All of it
// is a function of the definitions and of the time, worked out anew for each tick.

/// For the tick from now: targets of motors, and the velocities that bring kinematic bodies to
/// where they are to be at its end. Wakes what motors begin to move. Error: a course has no finite
/// value; nothing is changed.
Status follow_courses(WorldState& state);

/// Only the targets, for questions about the moment; those without a finite value stay.
void set_motor_targets(WorldState& state);

/// Puts a body that has a course to where it is to be now, and remembers it.
void begin_course(WorldState& state, uint32_t slot);
/// From here on the body goes by its velocity.
void end_course(WorldState& state, uint32_t slot);
/// Finds again who has a course.
void find_courses(WorldState& state);
bool has_courses(const WorldState& state);

}  // namespace tumble
