#pragma once
#include "engine/collision/bounds_tree.hpp"
#include "engine/collision/shape.hpp"
#include "engine/core/function_ref.hpp"
#include "engine/core/handle.hpp"
#include "engine/dynamics/bodies/mesh_source.hpp"
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

class TimeCourse;
struct BodyTag;
using BodyId = Handle<BodyTag>;

enum class BodyType : uint8_t {
  fixed,      ///< never moves ("static" in scene files)
  kinematic,  ///< moves by its velocity, which nothing changes
  dynamic,    ///< moved by forces and contacts
};

/// Rolling and torsional friction of materials that do not name them, under the realtime stepper
/// [m]: of the order of what dry wood on wood has
/// (tables give 0.5 to 1.5 mm for rolling), as if the bodies touched in a patch of a millimetre.
inline constexpr double default_turning_friction = 5e-4;

/// Surface properties of a shape; a contact combines two of them: friction sqrt(mu_A mu_B), rolling
/// and torsional friction likewise, restitution the larger.
struct Material {
  double friction = 0.5;   ///< Coulomb coefficient [-]
  double restitution = 0;  ///< coefficient of restitution, 0..1 [-]
  double density = 1000;   ///< [kg/m3]
  /// Velocity of the surface relative to the body, in body axes (conveyor belts) [m/s].
  Vec3 surface_velocity = Vec3::Zero();
  /// Lever arms of the torques with which a contact in a point or along a line resists turning
  /// under the normal force N: about axes in its tangent plane up to rolling_friction N, about its
  /// normal up to torsional_friction N [m]. Not given, default_turning_friction under the realtime
  /// stepper; under the event stepper none where neither of the two materials gives one.
  std::optional<double> rolling_friction = {}, torsional_friction = {};

  double rolling_arm() const { return rolling_friction.value_or(default_turning_friction); }
  double torsional_arm() const { return torsional_friction.value_or(default_turning_friction); }
};

/// How a body should look; carried for the viewer, without effect on the motion.
struct Look {
  Vec3f colour{0.8f, 0.8f, 0.8f};  ///< linear RGB, 0..1
  float roughness = 0.6f;          ///< 0 mirror .. 1 matte
  float metallic = 0;              ///< 0 or 1
  float pattern = 0;  ///< strength of the two-tone pattern that makes rotation visible, 0..1
  float opacity = 1;  ///< below 1 what is behind is seen through it; it then casts no shadow, 0..1
  bool visible = true;
};

struct BodyShapeDef {
  ShapeDef shape;
  Pose pose;  ///< shape frame in the body frame
  Material material;
  /// The mesh that it stands for, alone or with others of the same source; null: none is known.
  std::shared_ptr<const MeshSource> source = nullptr;
  /// Share of the material's density that `material` has: a piece weighs what the part of the mesh
  /// does that it stands for.
  double filled = 1;
};

/// How a kinematic body goes its way: displacement [m] along the world's axes and turn [rad] about
/// an axis through the origin of its frame, from where its definition places it. From tick to tick
/// it goes straight, with one velocity, from one place on its way to the next.
struct BodyCourse {
  std::array<std::shared_ptr<const TimeCourse>, 3> x;  ///< null: 0
  Vec3 axis = Vec3::UnitZ();                           ///< world axes; need not be unit
  std::shared_ptr<const TimeCourse> angle;             ///< null: 0
};

/// A shape that is drawn and does not collide.
struct DrawnShapeDef {
  ShapeDef shape;
  Pose pose;                    ///< shape frame in the body frame
  std::optional<Vec3f> colour;  ///< linear RGB, 0..1; the body's unless given
};

/// Everything needed to make a rigid body.
struct BodyDef {
  std::string name;
  BodyType type = BodyType::dynamic;
  Pose pose;                             ///< body frame in the world
  Vec3 velocity = Vec3::Zero();          ///< of the centre of mass [m/s]
  Vec3 angular_velocity = Vec3::Zero();  ///< world axes [rad/s]
  std::vector<BodyShapeDef> shapes;
  std::optional<double> mass;  ///< overrides the sum of density times volume [kg]
  /// Moments of inertia about the centre of mass, along the body frame's axes; overrides what the
  /// shapes give [kg m2]. With it and `mass` a body needs no shape.
  std::optional<Vec3> inertia;
  /// With `inertia`: the elements Ixy, Ixz, Iyz of its tensor; zero unless given [kg m2].
  std::optional<Vec3> products;
  /// With `inertia`: the centre of mass in the body frame; of the shapes, or the origin where there
  /// are none, unless given [m].
  std::optional<Vec3> centre;
  /// What is drawn in place of `shapes`, if anything.
  std::vector<DrawnShapeDef> drawn;
  uint32_t group = 0;        ///< bodies of one group do not collide with each other; 0: of none
  double gravity_scale = 1;  ///< [-]
  /// How much fluids stick to it, over FluidDef::wall_friction [-]: 0 lets them slide.
  double fluid_friction = 1;
  bool can_sleep = true;
  bool starts_asleep = false;
  bool precise = false;  ///< the realtime stepper solves the group that it is in precisely
  /// Take mass properties of a mesh that has none (open, non-manifold) from its convex hull; the
  /// world then logs it. Without it such a dynamic body is refused.
  bool hull_mass = false;
  std::shared_ptr<const BodyCourse> course;  ///< of a kinematic body; null: it keeps its velocity
  Look look;
};

/// A shape as carried by a live body.
struct BodyShape {
  std::shared_ptr<const Shape> shape;
  Pose pose;  ///< shape frame relative to the centre of mass, body axes
  Material material;
};

/// A shape that is drawn in place of those that collide.
struct DrawnShape {
  BodyShape part;               ///< its material has no meaning
  std::optional<Vec3f> colour;  ///< the body's unless given
};

/// How long a body has been slow in the mean: what decides whether it may sleep.
struct RestWatch {
  Vec3 v = Vec3::Zero();      ///< mean velocity of late [m/s]
  Vec3 omega = Vec3::Zero();  ///< likewise of turning, world axes [rad/s]
  double time = 0;            ///< [s]
};

/// State and constants of one live body. The frame of `pose` has its origin at the centre of mass
/// and the axes of the definition's body frame.
struct RigidBody {
  Pose pose;
  Vec3 v = Vec3::Zero();       ///< velocity of the centre of mass [m/s]
  Vec3 omega = Vec3::Zero();   ///< angular velocity, world axes [rad/s]
  Vec3 force = Vec3::Zero();   ///< sum over this tick, world axes [N]
  Vec3 torque = Vec3::Zero();  ///< about the centre of mass, world axes [N m]
  RestWatch rest;

  BodyType type = BodyType::dynamic;
  uint32_t group = 0;  ///< as in BodyDef
  bool asleep = false;
  bool can_sleep = true;
  bool precise = false;     ///< as in BodyDef
  bool teleported = false;  ///< pose was set from outside since the last frame
  /// Contacts are found along its whole way in a tick, where others look no farther than
  /// foresight(): particles of nets, of which the springs must know what stops one.
  bool looks_far = false;
  double gravity_scale = 1;
  double fluid_friction = 1;         ///< as in BodyDef
  double mass = 0;                   ///< [kg]; 0 for fixed and kinematic bodies
  double inverse_mass = 0;           ///< 0 for fixed and kinematic bodies
  Mat3 inertia_body = Mat3::Zero();  ///< about the centre of mass, body axes [kg m2]
  Mat3 inverse_inertia_body = Mat3::Zero();
  Vec3 centre_body = Vec3::Zero();  ///< centre of mass in the definition's body frame [m]
  double bounding_radius = 0;       ///< about the centre of mass [m]
  double inner_radius = 0;          ///< inner_radius_of; 0 of fixed ones [m]
  std::vector<BodyShape> shapes;
  /// Over the bounds of the shapes of a dynamic body that has several, in the frame of `pose`: it
  /// is paired with others as a whole. Null of others, of which each shape is: they may be hollow,
  /// and hold all that moves.
  std::shared_ptr<const BoundsTree> tree;
  std::shared_ptr<const std::vector<DrawnShape>> drawn;  ///< null: the shapes

  bool dynamic() const { return type == BodyType::dynamic; }
  bool awake() const { return type != BodyType::fixed && !asleep; }
  Mat3 inverse_inertia_world() const {
    const Mat3 R = pose.q.toRotationMatrix();
    return R * inverse_inertia_body * R.transpose();
  }
  Mat3 inertia_world() const {
    const Mat3 R = pose.q.toRotationMatrix();
    return R * inertia_body * R.transpose();
  }
  /// Velocity of the material point that is now at x_world.
  Vec3 velocity_at(const Vec3& x_world) const { return v + omega.cross(x_world - pose.x); }
  /// The definition's body frame in the world.
  Pose body_frame() const { return {pose.x - pose.direction(centre_body), pose.q}; }
  double kinetic_energy() const {
    return 0.5 * mass * v.squaredNorm() + 0.5 * omega.dot(inertia_world() * omega);
  }
};

/// The bodies of a world by slot index. A dead slot holds a default RigidBody (fixed, no shapes).
struct BodySet {
  HandlePool<BodyTag> ids;
  std::vector<RigidBody> bodies;  ///< indexed by BodyId::index, ids.capacity() long

  RigidBody* find(BodyId id) { return ids.contains(id) ? &bodies[id.index] : nullptr; }
  const RigidBody* find(BodyId id) const { return ids.contains(id) ? &bodies[id.index] : nullptr; }
};

/// Builds or finds the shape of a definition; worlds pass one that shares equal shapes.
using ShapeFactory = FunctionRef<Result<std::shared_ptr<const Shape>>(const ShapeDef&)>;

/// Fills the constants of a body from its definition: shapes, mass, inertia, centre.
/// Errors name the shape and the value.
Result<RigidBody> make_body(const BodyDef& def, ShapeFactory make);
/// With shapes of its own.
Result<RigidBody> make_body(const BodyDef& def);

}  // namespace tumble
