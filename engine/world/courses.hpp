#pragma once
#include "engine/world/state.hpp"

namespace tumble {

// What follows a course over time (TimeCourse): targets of motors, kinematic bodies, numbers of
// forces, and gravity. All of it is a function of the definitions and of the time, worked out anew
// for each tick.

/// For the tick from now: targets of motors, the velocities that bring kinematic bodies to where
/// they are to be at its end, and forces and gravity as they are in its middle. Wakes what motors,
/// forces and gravity begin to move. Error: a course has no finite value, or leaves the range of a
/// force's number; nothing is changed.
Status follow_courses(WorldState& state);

/// What the energy of forces and of gravity gains by their courses over a tick, at the places where
/// things are before and after it: (U(x0, t1) - U(x0, t0) + U(x1, t1) - U(x1, t0)) / 2. Its error
/// is of third order in the tick where courses are smooth; where they jump it is what they do. None
/// for forces without a potential, which do work.
class CourseSupply {
 public:
  /// Before the tick.
  explicit CourseSupply(WorldState& state);
  /// After the tick, before time is counted on: books it, and leaves forces and gravity as they are
  /// at its end.
  void book(WorldState& state) const;

 private:
  std::vector<double> before_;          ///< by place in forces_on_course [J]
  Vec3 weighed_before_ = Vec3::Zero();  ///< sum of mass times position, if gravity varies [kg m]
};

/// Only the targets, for questions about the moment; those without a finite value stay.
void set_motor_targets(WorldState& state);

/// How bodies on courses move through the coming tick, given that their velocities are its means:
/// each velocity changes linearly in time, with a limited slope estimated from the mean velocities
/// of this tick and its neighbours, so that it jumps only where the course does. Bodies at rest are
/// left out. The result is kept in the workspace until the next call.
std::span<const CourseMotion> course_motions(WorldState& state);
/// Gives these bodies their velocities at the end of the tick, which has moved them with its means.
void end_tick_on_courses(WorldState& state, std::span<const CourseMotion> motions);
/// The velocities of all bodies on courses as they are now, and their present accelerations.
std::vector<CourseMotion> course_changes(const WorldState& state);

/// Places a body that has a course at its prescribed pose of now, and adds it to `on_course`.
void begin_course(WorldState& state, uint32_t slot);
/// Removes the course of a body, which then moves by its velocity.
void end_course(WorldState& state, uint32_t slot);
/// Sets the numbers of a force that was made or changed to their values of now, and records whether
/// it follows courses.
void begin_force(WorldState& state, uint32_t slot);
/// Gives the numbers of all forces, and gravity, their values of now.
void return_to_now(WorldState& state);
/// Gravity at a time, as its course has it [m/s2]. May be called concurrently.
Vec3 gravity_at(const WorldState& state, double t);
/// The greatest strength that it has at the beginning, in the middle or at the end of the tick
/// [m/s2].
double greatest_gravity(const WorldState& state);
/// Rebuilds the lists of bodies and forces on courses from the definitions.
void find_courses(WorldState& state);
bool has_courses(const WorldState& state);

}  // namespace tumble
