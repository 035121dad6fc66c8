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
  kinematic,  ///< moves with its prescribed velocity, which no force changes
  dynamic,    ///< moved by forces and contacts
};

/// Lever arm of rolling and torsional friction of materials that do not give one, under the
/// realtime stepper [m]: of the order of that of dry wood on wood (tables give 0.5 to 1.5 mm for
/// rolling), as if bodies touched in a patch of a millimetre.
inline constexpr double default_turning_friction = 5e-4;

/// Surface properties of a shape. A contact combines those of two shapes: friction sqrt(mu_A mu_B),
/// rolling and torsional friction likewise, the larger restitution.
struct Material {
  double friction = 0.5;   ///< Coulomb coefficient [-]
  double restitution = 0;  ///< coefficient of restitution, 0..1 [-]
  double density = 1000;   ///< [kg/m3]
  /// Velocity of the surface relative to the body, in body axes (conveyor belts) [m/s].
  Vec3 surface_velocity = Vec3::Zero();
  /// Lever arms [m] of the torques with which a point or line contact under normal force N resists
  /// relative rotation: up to rolling_friction N about axes in its tangent plane, up to
  /// torsional_friction N about its normal. If not given: default_turning_friction under the
  /// realtime stepper; under the event stepper none, unless the other material gives one.
  std::optional<double> rolling_friction = {}, torsional_friction = {};

  double rolling_arm() const { return rolling_friction.value_or(default_turning_friction); }
  double torsional_arm() const { return torsional_friction.value_or(default_turning_friction); }
};

/// Appearance of a body, for the viewer; no effect on the motion.
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
  /// The mesh that the shape represents, alone or with other shapes of the same source; null: none
  /// is known.
  std::shared_ptr<const MeshSource> source = nullptr;
  /// Density of `material` relative to that of the original material: scales the mass of a piece to
  /// that of the part of the mesh that it represents.
  double filled = 1;
};

/// Prescribed motion of a kinematic body: displacement [m] along the world's axes and rotation
/// [rad] about an axis through the origin of its frame, relative to the pose in its definition.
/// Within a tick it moves with constant velocity from one point of the course to the next.
struct BodyCourse {
  std::array<std::shared_ptr<const TimeCourse>, 3> x;  ///< null: 0
  Vec3 axis = Vec3::UnitZ();                           ///< world axes; need not be unit
  std::shared_ptr<const TimeCourse> angle;             ///< null: 0
};

/// A shape that is drawn but does not collide.
struct DrawnShapeDef {
  ShapeDef shape;
  Pose pose;                    ///< shape frame in the body frame
  std::optional<Vec3f> colour;  ///< linear RGB, 0..1; the body's unless given
};

/// Definition of a rigid body.
struct BodyDef {
  std::string name;
  BodyType type = BodyType::dynamic;
  Pose pose;                             ///< body frame in the world
  Vec3 velocity = Vec3::Zero();          ///< of the centre of mass [m/s]
  Vec3 angular_velocity = Vec3::Zero();  ///< world axes [rad/s]
  std::vector<BodyShapeDef> shapes;
  std::optional<double> mass;  ///< overrides the sum of density times volume [kg]
  /// Moments of inertia about the centre of mass, along the axes of the body frame; overrides those
  /// of the shapes [kg m2]. With it and `mass` a body needs no shape.
  std::optional<Vec3> inertia;
  /// With `inertia`: the elements Ixy, Ixz, Iyz of the tensor; zero if not given [kg m2].
  std::optional<Vec3> products;
  /// With `inertia`: the centre of mass in the body frame [m]; if not given, that of the shapes, or
  /// the origin if there are none.
  std::optional<Vec3> centre;
  /// Drawn in place of `shapes`, if not empty.
  std::vector<DrawnShapeDef> drawn;
  uint32_t group = 0;        ///< bodies of one group do not collide with each other; 0: no group
  double gravity_scale = 1;  ///< [-]
  /// Friction of fluids on it relative to FluidDef::wall_friction [-]: 0 lets them slide.
  double fluid_friction = 1;
  bool can_sleep = true;
  bool starts_asleep = false;
  bool precise = false;  ///< the realtime stepper solves its island precisely
  /// Takes the mass properties of a mesh that has none (open, non-manifold) from its convex hull,
  /// and logs it. Otherwise a dynamic body with such a mesh is refused.
  bool hull_mass = false;
  std::shared_ptr<const BodyCourse> course;  ///< for a kinematic body; null: it keeps its velocity
  Look look;
};

/// A shape of a live body.
struct BodyShape {
  std::shared_ptr<const Shape> shape;
  Pose pose;  ///< shape frame relative to the centre of mass, body axes
  Material material;
};

/// A shape that is drawn in place of those that collide.
struct DrawnShape {
  BodyShape part;               ///< its material is not used
  std::optional<Vec3f> colour;  ///< the body's unless given
};

/// How long a body has rested: decides whether it may sleep.
struct RestWatch {
  Vec3 v = Vec3::Zero();      ///< averaged velocity [m/s]
  Vec3 omega = Vec3::Zero();  ///< averaged angular velocity, world axes [rad/s]
  double time = 0;            ///< for how long it has rested [s]
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
  /// Contacts are found along its whole path in a tick, where other bodies look no farther than
  /// foresight(): for particles of nets, whose springs must react to a contact in time.
  bool looks_far = false;
  double gravity_scale = 1;
  double fluid_friction = 1;         ///< as in BodyDef
  double mass = 0;                   ///< [kg]; 0 for fixed and kinematic bodies
  double inverse_mass = 0;           ///< 0 for fixed and kinematic bodies
  Mat3 inertia_body = Mat3::Zero();  ///< about the centre of mass, body axes [kg m2]
  Mat3 inverse_inertia_body = Mat3::Zero();
  Vec3 centre_body = Vec3::Zero();  ///< centre of mass in the definition's body frame [m]
  double bounding_radius = 0;       ///< about the centre of mass [m]
  double inner_radius = 0;          ///< inner_radius_of(); 0 for fixed bodies [m]
  std::vector<BodyShape> shapes;
  /// Bounding tree over the shapes of a dynamic body of several shapes, in the frame of `pose`: the
  /// body is paired with others as a whole. Null for other bodies, whose shapes are paired one by
  /// one: fixed and kinematic bodies may be hollow and contain everything that moves.
  std::shared_ptr<const BoundsTree> tree;
  std::shared_ptr<const std::vector<DrawnShape>> drawn;  ///< null: the colliding shapes are drawn

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

/// Builds or finds the shape of a definition; worlds pass a factory that shares equal shapes.
using ShapeFactory = FunctionRef<Result<std::shared_ptr<const Shape>>(const ShapeDef&)>;

/// Makes a live body from its definition, with shapes, mass, inertia and centre of mass. Errors
/// name the shape and the value.
Result<RigidBody> make_body(const BodyDef& def, ShapeFactory make);
/// The same, with shapes that are not shared.
Result<RigidBody> make_body(const BodyDef& def);

}  // namespace tumble
