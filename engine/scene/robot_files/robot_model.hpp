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
  ShapeDef shape;              ///< when it is no mesh
  std::filesystem::path mesh;  ///< the file; empty for a shape
  Vec3 scale{1, 1, 1};         ///< of the mesh
  Pose pose;                   ///< of the shape's frame in the link's
  std::optional<Colour> colour;
  std::optional<double> friction;
};

/// What holds a coordinate where it should be.
struct RobotActuator {
  enum class Kind { position, damper, force };
  Kind kind = Kind::force;
  double target = 0;  ///< coordinate, or force
  double stiffness = 0, damping = 0;
  std::optional<double> max_force;
};

/// The coordinate is another joint's, times `multiplier`, plus `offset` [rad] or [m].
struct RobotMimic {
  std::string joint;
  double multiplier = 1, offset = 0;
};

/// One coordinate (a ball: three) between a link and what is before it. Angles in radians.
struct RobotJoint {
  enum class Kind { hinge, slide, ball };
  std::string name;
  RobotPlace at;
  Kind kind = Kind::hinge;
  Vec3 anchor = Vec3::Zero();  ///< in the link's frame, as the file places the link [m]
  Vec3 axis{0, 0, 1};          ///< likewise, unit
  std::optional<double> lower, upper;
  double damping = 0, friction = 0, armature = 0, stiffness = 0, rest = 0;
  double reference = 0;          ///< the coordinate as the file places the link
  double start = 0;              ///< the coordinate at the start
  std::optional<double> target;  ///< where a motor pulls it, instead of where the file says
  std::optional<double> effort;  ///< greatest force of what drives it
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
  size_t parent = world;           ///< a link that comes before, or the world
  Pose in_parent;                  ///< as the file places it
  std::vector<RobotJoint> joints;  ///< from the parent on; none: it is welded to it
  bool floating = false;           ///< nothing ties it to its parent
};

/// What keeps two links together in a loop, or apart.
struct RobotTie {
  enum class Kind { point, weld, apart };
  std::string name;
  RobotPlace at;
  Kind kind = Kind::point;
  size_t a = RobotLink::world, b = RobotLink::world;
  Vec3 anchor = Vec3::Zero();  ///< in the frame of a [m]
};

/// What a robot file says, whichever its format. Parents come before their children.
struct RobotModel {
  std::string name;
  std::filesystem::path file;
  std::vector<RobotLink> links;
  std::vector<RobotGeometry> scenery;  ///< of the world
  std::vector<RobotTie> ties;
  std::optional<Vec3> gravity;  ///< z up [m/s2]
};

// Geometries whose axis is z, as robot files have it.
ShapeDef robot_sphere(double radius);
ShapeDef robot_box(const Vec3& half_extents);
ShapeDef robot_ellipsoid(const Vec3& semi_axes);
/// `length` without the caps.
ShapeDef robot_capsule(double radius, double length);
ShapeDef robot_cylinder(double radius, double length);
ShapeDef robot_plane();
ShapeDef robot_hull(std::shared_ptr<const TriangleMesh> points);
/// Turns the y axis of Tumble's shapes into the z axis of the files'.
Quat z_from_y();

/// The pose of every link at the start, in the file's world (z up).
std::vector<Pose> start_poses(const RobotModel& model);
/// How far a joint has moved its link at the start, in the link's frame.
Pose displacement(const RobotJoint& joint);

}  // namespace tumble
