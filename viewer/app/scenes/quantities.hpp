#pragma once
#include "engine/world/frame.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

struct BuiltScene;

/// The value of a named quantity of a frame, as `--assert` uses it; empty for unknown names.
///
/// - time tick bodies awake islands contacts contact_points max_penetration events impacts
///   fallbacks time_stepped joints broken_joints
/// - energy energy.kinetic energy.gravity energy.springs energy.fields
/// - energy.drift energy.throughput (Ledger::drift, ::throughput)
/// - ledger.LINE, .work, .momentum.x, .angular_momentum.x with LINE of LedgerLine or forces.NAME
/// - momentum.x .y .z, angular_momentum.x .y .z
/// - bodies.NAME.position.x (.y .z), .velocity, .angular_velocity, .speed, .angular_speed, .mass,
///   .asleep, .up.x (the body's y axis in the world), .fluid_force.x, .fluid_torque.x
/// - joints.NAME.angle, .angle_deg, .angle_rate, .angle_motor_torque or .position_motor_force, also
///   as .angle_motor and .position_motor, by the names of coordinates; .rate and .motor_torque or
///   .motor_force if there is only one coordinate; .reaction.x, .reaction_torque.x (in the joint's
///   frame on a), .broken
/// - particles.NAME.count .speed .max_speed .temperature .pressure, .centre.x, .low.x, .high.x (see
///   ParticleMeasures)
/// - sensors.NAME.count and the other numbers of sensor_values(); .holds.BODY of a region
///
/// with NAME as in the scene: ball, brick[3].
std::optional<double> quantity(const BuiltScene& scene, const Frame& frame, std::string_view name);

/// The value of a quantity, or of a parameter of the scene.
std::optional<double> named_value(const BuiltScene& scene, const Frame& frame,
                                  std::string_view name);
/// The part of a scene that quantity() needs, without its world.
std::shared_ptr<const BuiltScene> names_of(const BuiltScene& scene);
/// SI unit of a quantity; "" for pure numbers, for coordinates of joints that may be angles or
/// lengths, and for whole expressions.
std::string unit_of_quantity(std::string_view name);

/// All names of quantities of this scene, e.g. to suggest corrections of misspelt ones.
std::vector<std::string> quantity_names(const BuiltScene& scene);
/// All names for the things in `names` that exist in a frame.
std::vector<std::string> quantity_names(const BuiltScene& names, const Frame& frame);
/// The names together with those of things in the frame that were added since.
std::shared_ptr<const BuiltScene> names_with(const BuiltScene& names, const Frame& frame);

/// The quantities of a joint that depend on time: its coordinates and reactions.
std::vector<std::string> joint_quantities(const JointFrame& joint);

/// List of the names above, for help and messages.
std::string quantity_help();

}  // namespace tumble
