#pragma once
#include "engine/dynamics/joints/joint.hpp"
#include "engine/scene/description/drive.hpp"
#include "engine/scene/description/values.hpp"

#include <cmath>
#include <optional>
#include <string>

namespace tumble {

template <>
struct EnumNames<JointKind> {
  static constexpr std::array<std::pair<std::string_view, JointKind>, 9> values = {
      {{"spherical", JointKind::spherical},
       {"universal", JointKind::universal},
       {"revolute", JointKind::revolute},
       {"cylindrical", JointKind::cylindrical},
       {"prismatic", JointKind::prismatic},
       {"rigid", JointKind::rigid},
       {"distance", JointKind::distance},
       {"planar", JointKind::planar},
       {"free", JointKind::free}}};
};

/// "the coordinates of a planar joint are: x, y, angle".
std::string names_of_coordinates(const JointKindEntry& kind);

/// A joint of two bodies, or of a body and the world, in their configuration at the start.
struct JointDescription {
  JointKind kind = JointKind::spherical;
  std::string a, b;
  Vec3 anchor = Vec3::Zero();     ///< in A's frame [m]
  Vec3 axis{0, 0, 1};             ///< in A's frame; need not be unit
  std::optional<Vec3> axis_b;     ///< of a universal joint, in A's frame
  std::optional<Vec3> anchor_b;   ///< in B's frame [m]
  std::optional<Vec3> axis_on_b;  ///< in B's frame; need not be unit
  std::optional<double> length;
  std::optional<double> start, start_deg;
  bool collide = false;
  int count = 1;
  DriveDescription drive;  ///< for a joint with one coordinate
  /// By the names of the coordinates.
  std::optional<DriveDescription> angle, angle_2, position, x, y, swing, twist;
  std::optional<double> break_force, break_torque;

  static constexpr std::string_view schema_name = "joint";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.kind, {.name = "kind", .required = true, .doc = "which motion it leaves"});
    v.field(d.a, {.name = "a",
                  .doc = "name of a body, or of a copy: \"link[3]\", with count also \"link[i]\"; "
                         "the world unless given"});
    v.field(d.b, {.name = "b", .required = true, .doc = "name of the other body"});
    v.field(d.anchor, {.name = "anchor",
                       .unit = "m",
                       .min = -1e7,
                       .max = 1e7,
                       .doc = "where it is, in the frame of a; without a in the world"});
    v.field(d.axis, {.name = "axis",
                     .min = -1e9,
                     .max = 1e9,
                     .doc = "of turning or sliding, across a plane; in the frame of a"});
    v.field(d.axis_b, {.name = "axis_b",
                       .min = -1e9,
                       .max = 1e9,
                       .doc = "of a universal joint: the second axis, across the first, which "
                              "stays with b; in the frame of a"});
    v.field(d.anchor_b, {.name = "anchor_b",
                         .unit = "m",
                         .min = -1e7,
                         .max = 1e7,
                         .doc = "where it is on b, in the frame of b; unless given where a has it "
                                "at the start, of a distance or free joint the origin of b"});
    v.field(d.axis_on_b, {.name = "axis_on_b",
                          .min = -1e9,
                          .max = 1e9,
                          .doc = "the axis on b, in the frame of b; unless given where a has it at "
                                 "the start"});
    v.field(d.length, {.name = "length",
                       .unit = "m",
                       .min = 0,
                       .max = 1e7,
                       .exclusive_min = true,
                       .doc = "of a distance joint; what it is at the start unless given"});
    v.field(d.start, {.name = "start",
                      .unit = "m",
                      .min = -1e7,
                      .max = 1e7,
                      .doc = "of a prismatic joint: its position as the bodies stand at the "
                             "start; 0 unless given"});
    v.field(d.start_deg, {.name = "start_deg",
                          .unit = "deg",
                          .min = -180,
                          .max = 180,
                          .doc = "of a revolute joint: its angle as the bodies stand at the "
                                 "start; 0 unless given"});
    v.field(d.collide, {.name = "collide", .doc = "whether a and b may touch each other"});
    v.field(d.count,
            {.name = "count",
             .min = 1,
             .max = 200000,
             .doc = "so many joints: in brackets of a and b stands an expression in i = 0, "
                    "1, ..., such as \"link[i+1]\""});
    v.part(d.drive);
    for_drives(d, [&v](std::string_view name, auto& drive) {
      v.object(drive, {.name = name, .doc = "what acts along the coordinate of this name"});
    });
    v.field(d.break_force, {.name = "break_force",
                            .unit = "N",
                            .min = 0,
                            .max = 1e15,
                            .exclusive_min = true,
                            .doc = "it breaks when its force in the mean of a tick is greater"});
    v.field(d.break_torque, {.name = "break_torque",
                             .unit = "N m",
                             .min = 0,
                             .max = 1e15,
                             .exclusive_min = true,
                             .doc = "likewise of its torque about the anchor"});
  }
  /// Calls f(name, drive) for the coordinates that have a key of their own.
  template <class Self, class F>
  static void for_drives(Self& d, const F& f) {
    f("angle", d.angle);
    f("angle_2", d.angle_2);
    f("position", d.position);
    f("x", d.x);
    f("y", d.y);
    f("swing", d.swing);
    f("twist", d.twist);
  }
  static void check(const JointDescription& d, Complaints& complaints) {
    if (!(d.axis.squaredNorm() > 1e-20))
      complaints.add("axis", "an axis of zeros has no direction");
    const bool distance = d.kind == JointKind::distance;
    if (d.axis_on_b && !(d.axis_on_b->squaredNorm() > 1e-20))
      complaints.add("axis_on_b", "an axis of zeros has no direction");
    if (d.axis_on_b && d.kind == JointKind::universal)
      complaints.add("axis_on_b", "the axis on b of a universal joint is axis_b");
    if (!distance && d.length) complaints.add("length", "only a distance joint has a length");
    if (d.start && d.kind != JointKind::prismatic)
      complaints.add("start", "only a prismatic joint has one");
    if (d.start_deg && d.kind != JointKind::revolute)
      complaints.add("start_deg", "only a revolute joint has one");
    check_drives(d, complaints);
    if (!d.axis_b) return;
    if (d.kind != JointKind::universal)
      return complaints.add("axis_b", "only a universal joint has two axes");
    const double sine = d.axis.cross(*d.axis_b).norm();
    if (!(std::fabs(d.axis.dot(*d.axis_b)) <= 1e-3 * sine))
      complaints.add("axis_b", "must be at right angles to axis");
  }

 private:
  static void check_drives(const JointDescription& d, Complaints& complaints);
};

}  // namespace tumble
