#pragma once
#include "engine/world/frame.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

struct BuiltScene;

/// The value of a named quantity of a frame, as `--assert` uses it; nothing for unknown names.
///
/// - time tick bodies awake islands contacts contact_points max_penetration events impacts
///   fallbacks time_stepped joints broken_joints
/// - energy energy.kinetic energy.gravity energy.springs energy.fields
/// - energy.drift energy.throughput (Ledger::drift, ::throughput)
/// - ledger.LINE, .work, .momentum.x, .angular_momentum.x with LINE of LedgerLine or forces.NAME
/// - momentum.x .y .z, angular_momentum.x .y .z
/// - bodies.NAME.position.x (.y .z), .velocity, .angular_velocity, .speed, .angular_speed, .mass,
///   .asleep, .up.x (the body's y axis in the world), .fluid_force.x, .fluid_torque.x
/// - joints.NAME.angle, .angle_deg, .angle_rate, .angle_motor_torque or .position_motor_force (of
///   both also .._motor), by the names of coordinates; .rate and .motor_torque where there is one;
///   .reaction.x,
///   .reaction_torque.x (in the joint's frame on a), .broken
/// - particles.NAME.count .speed .max_speed .temperature .pressure, .centre.x, .low.x, .high.x (see
///   ParticleMeasures)
/// - sensors.NAME.count and the other numbers of sensor_values(); .holds.BODY of a region
///
/// with NAME as in the scene: ball, brick[3].
std::optional<double> quantity(const BuiltScene& scene, const Frame& frame, std::string_view name);

/// The same, or the value of a parameter of the scene.
std::optional<double> named_value(const BuiltScene& scene, const Frame& frame,
                                  std::string_view name);
/// What quantity() needs of a scene, without its world.
std::shared_ptr<const BuiltScene> names_of(const BuiltScene& scene);
/// SI unit of a quantity, "" for pure numbers, angles of joints that may be lengths, and whole
/// expressions.
std::string unit_of_quantity(std::string_view name);

/// Every name of this scene, for "did you mean".
std::vector<std::string> quantity_names(const BuiltScene& scene);
/// The same of the names in `names` at a moment.
std::vector<std::string> quantity_names(const BuiltScene& names, const Frame& frame);
/// The names with those of everything else that is there in a frame: what was built meanwhile.
std::shared_ptr<const BuiltScene> names_with(const BuiltScene& names, const Frame& frame);

/// What there is to know of a joint over time: its coordinates and reactions.
std::vector<std::string> joint_quantities(const JointFrame& joint);

/// The names above, for help and messages.
std::string quantity_help();

}  // namespace tumble
