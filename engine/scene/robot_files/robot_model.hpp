#pragma once
#include "engine/collision/shape.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/description/values.hpp"
#include "engine/scene/robot_files/robot_log.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// A shape or a mesh of a link.
struct RobotGeometry {
  RobotPlace at;
  ShapeDef shape;              ///< if it is not a mesh
  std::filesystem::path mesh;  ///< the file; empty for a shape
  Vec3 scale{1, 1, 1};         ///< of the mesh
  Pose pose;                   ///< of the shape's frame in the link's
  std::optional<Colour> colour;
  std::optional<double> friction;
};

/// A motor that acts on a coordinate.
struct RobotActuator {
  enum class Kind { position, damper, force };
  Kind kind = Kind::force;
  double target = 0;  ///< coordinate, or force
  double stiffness = 0, damping = 0;
  std::optional<double> max_force;
};

/// Couples the coordinate to another joint's: it is that times `multiplier`, plus `offset` [rad] or
/// [m].
struct RobotMimic {
  std::string joint;
  double multiplier = 1, offset = 0;
};

/// One coordinate (for a ball joint three) between a link and its parent. Angles in radians.
struct RobotJoint {
  enum class Kind { hinge, slide, ball };
  std::string name;
  RobotPlace at;
  Kind kind = Kind::hinge;
  Vec3 anchor = Vec3::Zero();  ///< in the link's frame, as the file places the link [m]
  Vec3 axis{0, 0, 1};          ///< likewise, unit
  std::optional<double> lower, upper;
  double damping = 0, friction = 0, armature = 0, stiffness = 0, rest = 0;
  double reference = 0;          ///< value of the coordinate in the file's pose of the link
  double start = 0;              ///< the coordinate at the start
  std::optional<double> target;  ///< target of the motor, instead of the file's
  std::optional<double> effort;  ///< greatest force or torque of the motor
  std::optional<RobotActuator> actuator;
  std::optional<RobotMimic> mimic;
};

/// A link, or a body of MJCF, in the frame that its file gives it (z up).
struct RobotLink {
  static constexpr size_t world = ~size_t{0};
  std::string name;
  RobotPlace at;
  MassProperties mass;  ///< in the link's frame; mass 0: it has none
  std::vector<RobotGeometry> collides, drawn;
  size_t parent = world;           ///< an earlier link, or the world
  Pose in_parent;                  ///< as the file places it
  std::vector<RobotJoint> joints;  ///< in order from the parent; none: it is welded to it
  bool floating = false;           ///< it is not attached to its parent
};

/// A constraint that closes a loop between two links, or excludes their collision.
struct RobotTie {
  enum class Kind { point, weld, apart };
  std::string name;
  RobotPlace at;
  Kind kind = Kind::point;
  size_t a = RobotLink::world, b = RobotLink::world;
  Vec3 anchor = Vec3::Zero();  ///< in the frame of a [m]
};

/// The content of a robot file, independent of its format. Parents come before their children.
struct RobotModel {
  std::string name;
  std::filesystem::path file;
  std::vector<RobotLink> links;
  std::vector<RobotGeometry> scenery;  ///< of the world
  std::vector<RobotTie> ties;
  std::optional<Vec3> gravity;  ///< z up [m/s2]
};

// Geometries whose axis is z, as in robot files.
ShapeDef robot_sphere(double radius);
ShapeDef robot_box(const Vec3& half_extents);
ShapeDef robot_ellipsoid(const Vec3& semi_axes);
/// `length` without the caps.
ShapeDef robot_capsule(double radius, double length);
ShapeDef robot_cylinder(double radius, double length);
ShapeDef robot_plane();
ShapeDef robot_hull(std::shared_ptr<const TriangleMesh> points);
/// Rotates the y axis of Tumble's shapes to the z axis of the files'.
Quat z_from_y();

/// The pose of every link at the start, in the file's world (z up).
std::vector<Pose> start_poses(const RobotModel& model);
/// Displacement of a link by its joint at the start, in the link's frame.
Pose displacement(const RobotJoint& joint);

}  // namespace tumble
