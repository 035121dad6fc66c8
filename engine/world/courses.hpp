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

/// How bodies on courses go through the tick from now, whose mean velocities they have: velocities
/// change evenly, by the slopes that those of the ticks before and after let one see, and jump only
/// where courses do. Those at rest are left out.
std::vector<CourseMotion> course_motions(const WorldState& state);
/// Their velocities as they are, and how these change at the moment.
std::vector<CourseMotion> course_changes(const WorldState& state);

/// Puts a body that has a course to where it is to be now, and remembers it.
void begin_course(WorldState& state, uint32_t slot);
/// From here on the body goes by its velocity.
void end_course(WorldState& state, uint32_t slot);
/// Finds again who has a course.
void find_courses(WorldState& state);
bool has_courses(const WorldState& state);

}  // namespace tumble
