#pragma once
#include "engine/scene/description/values.hpp"

#include <optional>
#include <string>

namespace tumble {

// Drives along a coordinate of a joint. Lengths are in metres; angles have the suffix _deg, except
// rates and stiffnesses, which are per radian.

/// Bounds of a coordinate.
struct LimitsDescription {
  std::optional<double> lower, upper, lower_deg, upper_deg;
  double stiffness = 0, damping = 0, restitution = 0;

  static constexpr std::string_view schema_name = "joint_limits";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.lower,
            {.name = "lower", .unit = "m", .min = -1e7, .max = 1e7, .doc = "least length"});
    v.field(d.upper,
            {.name = "upper", .unit = "m", .min = -1e7, .max = 1e7, .doc = "greatest length"});
    v.field(d.lower_deg,
            {.name = "lower_deg", .unit = "deg", .min = -1e7, .max = 1e7, .doc = "least angle"});
    v.field(d.upper_deg,
            {.name = "upper_deg", .unit = "deg", .min = -1e7, .max = 1e7, .doc = "greatest angle"});
    v.field(d.stiffness, {.name = "stiffness",
                          .unit = "N/m, N m/rad",
                          .min = 0,
                          .max = 1e12,
                          .doc = "of a stop that gives way; hard unless given"});
    v.field(d.damping, {.name = "damping",
                        .unit = "N s/m, N m s/rad",
                        .min = 0,
                        .max = 1e12,
                        .doc = "of a stop that gives way"});
    v.field(d.restitution, {.name = "restitution",
                            .min = 0,
                            .max = 1,
                            .doc = "of a hard stop: speed after an impact over that before"});
  }
  static void check(const LimitsDescription& d, Complaints& complaints) {
    if (!d.lower && !d.upper && !d.lower_deg && !d.upper_deg)
      complaints.add("", "needs at least one of lower, upper, lower_deg, upper_deg");
    if ((d.lower && d.upper && *d.lower > *d.upper) ||
        (d.lower_deg && d.upper_deg && *d.lower_deg > *d.upper_deg))
      complaints.add("", "the lower limit is above the upper one");
    if (d.stiffness == 0 && d.damping > 0)
      complaints.add("damping", "a hard stop has no damping: give it stiffness");
    if (d.stiffness > 0 && d.restitution > 0)
      complaints.add("restitution",
                     "only a hard stop has one: leave out stiffness, or use damping");
  }
};

/// Exactly one of velocity, position, position_deg and force, which may be functions of time.
struct MotorDescription {
  std::optional<Varying> velocity, position, position_deg, force;
  std::optional<double> stiffness, damping, max_force;

  static constexpr std::string_view schema_name = "joint_motor";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.velocity, {.name = "velocity",
                         .unit = "m/s, rad/s",
                         .min = -1e9,
                         .max = 1e9,
                         .doc = "rate that it holds, with whatever force that takes; may be an "
                                "expression in t, or a table of [time, rate]"});
    v.field(d.position, {.name = "position",
                         .unit = "m",
                         .min = -1e7,
                         .max = 1e7,
                         .doc = "length that it pulls towards by stiffness and damping; may be an "
                                "expression in t, or a table"});
    v.field(d.position_deg,
            {.name = "position_deg",
             .unit = "deg",
             .min = -1e7,
             .max = 1e7,
             .doc = "angle that it pulls towards by stiffness and damping; may be an "
                    "expression in t, or a table"});
    v.field(d.force, {.name = "force",
                      .unit = "N, N m",
                      .min = -1e15,
                      .max = 1e15,
                      .doc = "force, of an angle torque; may be an expression in t, or a table"});
    v.field(d.stiffness, {.name = "stiffness",
                          .unit = "N/m, N m/rad",
                          .min = 0,
                          .max = 1e12,
                          .doc = "of a position motor"});
    v.field(d.damping, {.name = "damping",
                        .unit = "N s/m, N m s/rad",
                        .min = 0,
                        .max = 1e12,
                        .doc = "of a position motor"});
    v.field(d.max_force, {.name = "max_force",
                          .unit = "N, N m",
                          .min = 0,
                          .max = 1e15,
                          .doc = "greatest force, of an angle torque; without bound unless given"});
  }
  static void check(const MotorDescription& d, Complaints& complaints) {
    const bool held = d.position || d.position_deg;
    if (int(d.velocity.has_value()) + int(d.position.has_value()) +
            int(d.position_deg.has_value()) + int(d.force.has_value()) !=
        1)
      complaints.add("", "needs exactly one of velocity, position, position_deg and force");
    if (held && !(d.stiffness && *d.stiffness > 0))
      complaints.add("stiffness", "a position motor needs a stiffness above 0");
    if (!held && (d.stiffness || d.damping))
      complaints.add(d.stiffness ? "stiffness" : "damping", "only a position motor has one");
    if (d.force && d.max_force) complaints.add("max_force", "a given force has no bound");
  }
};

struct JointSpringDescription {
  double stiffness = 0, damping = 0;
  std::optional<double> rest, rest_deg;

  static constexpr std::string_view schema_name = "joint_spring";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.stiffness, {.name = "stiffness",
                          .unit = "N/m, N m/rad",
                          .min = 0,
                          .max = 1e12,
                          .doc = "spring constant; 0: a damper alone"});
    v.field(d.damping, {.name = "damping",
                        .unit = "N s/m, N m s/rad",
                        .min = 0,
                        .max = 1e12,
                        .doc = "damping constant"});
    v.field(d.rest, {.name = "rest",
                     .unit = "m",
                     .min = -1e7,
                     .max = 1e7,
                     .doc = "length at which it does not pull; 0 unless given"});
    v.field(d.rest_deg, {.name = "rest_deg",
                         .unit = "deg",
                         .min = -1e7,
                         .max = 1e7,
                         .doc = "angle at which it does not pull; 0 unless given"});
  }
};

/// The coordinate x follows another one: x = ratio y + offset.
struct CoupleDescription {
  std::string joint, coordinate;
  double ratio = 1;
  std::optional<double> offset, offset_deg;

  static constexpr std::string_view schema_name = "joint_couple";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.joint, {.name = "joint",
                      .doc = "name of the joint whose coordinate it follows, or of a copy, as of "
                             "bodies: \"wheel[i-1]\"; the same joint unless given"});
    v.field(d.coordinate,
            {.name = "coordinate", .doc = "which one of that joint; its only one unless given"});
    v.field(d.ratio, {.name = "ratio",
                      .unit = "m/m, rad/rad, m/rad, rad/m",
                      .min = -1e7,
                      .max = 1e7,
                      .doc = "change of this coordinate by that of the other"});
    v.field(d.offset, {.name = "offset",
                       .unit = "m",
                       .min = -1e7,
                       .max = 1e7,
                       .doc = "length where the other is 0; 0 unless given"});
    v.field(d.offset_deg, {.name = "offset_deg",
                           .unit = "deg",
                           .min = -1e7,
                           .max = 1e7,
                           .doc = "angle where the other is 0; 0 unless given"});
  }
};

/// All drives along one coordinate.
struct DriveDescription {
  std::optional<LimitsDescription> limits;
  std::optional<MotorDescription> motor;
  std::optional<JointSpringDescription> spring;
  double friction = 0, armature = 0;
  std::optional<CoupleDescription> couple;

  static constexpr std::string_view schema_name = "joint_drive";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.object(d.limits, {.name = "limits", .doc = "where the coordinate must stay"});
    v.object(d.motor, {.name = "motor", .doc = "what drives it"});
    v.object(d.spring, {.name = "spring", .doc = "spring and damper along it"});
    v.field(d.friction, {.name = "friction",
                         .unit = "N, N m",
                         .min = 0,
                         .max = 1e15,
                         .doc = "greatest force of dry friction, of an angle torque"});
    v.field(d.armature, {.name = "armature",
                         .unit = "kg, kg m2",
                         .min = 0,
                         .max = 1e12,
                         .doc = "inertia along it, of a geared rotor"});
    v.object(d.couple, {.name = "couple", .doc = "the coordinate that it follows, as by gears"});
  }
  bool empty() const {
    return !limits && !motor && !spring && friction == 0 && armature == 0 && !couple;
  }
};

}  // namespace tumble
