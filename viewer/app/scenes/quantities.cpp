#include "viewer/app/scenes/quantities.hpp"

#include "engine/scene/build.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <tuple>
#include <utility>

namespace tumble {
namespace {

std::optional<double> component(const Vec3& v, std::string_view name) {
  if (name == "x") return v.x();
  if (name == "y") return v.y();
  if (name == "z") return v.z();
  return {};
}

/// Splits "momentum.x" at the first point.
std::pair<std::string_view, std::string_view> split(std::string_view name) {
  const size_t at = name.find('.');
  if (at == std::string_view::npos) return {name, {}};
  return {name.substr(0, at), name.substr(at + 1)};
}

std::optional<double> body_quantity(const BuiltScene& scene, const Frame& frame,
                                    std::string_view rest) {
  const auto [name, what] = split(rest);
  const auto found = scene.bodies.find(name);
  if (found == scene.bodies.end() || found->second.index >= frame.body_slots()) return {};
  const BodyFrame& body = frame.body(found->second.index);
  if (body.id != found->second) return {};
  const auto [vector, axis] = split(what);
  if (vector == "position") return component(body.pose.x, axis);
  if (vector == "velocity") return component(body.v, axis);
  if (vector == "angular_velocity") return component(body.omega, axis);
  if (vector == "fluid_force") return component(frame.fluid_force(body.id).force, axis);
  if (vector == "fluid_torque") return component(frame.fluid_force(body.id).torque, axis);
  if (vector == "up") return component(body.pose.direction(Vec3::UnitY()), axis);
  if (what == "speed") return body.v.norm();
  if (what == "angular_speed") return body.omega.norm();
  if (what == "mass") return frame.info(found->second.index).mass;
  if (what == "asleep") return body.asleep ? 1 : 0;
  return {};
}

/// Name of the force or torque of a coordinate's motor.
std::string_view motor_of(const JointCoordinate& c) {
  return c.angle ? "motor_torque" : "motor_force";
}

/// Evaluates "angle", "angle_deg", "angle_rate", "angle_motor" or "angle_motor_torque"; the last
/// three also as "rate", "motor" and "motor_torque" if there is only one coordinate.
std::optional<double> coordinate_quantity(const JointFrame& joint, std::string_view what) {
  const std::vector<JointCoordinate>& all = entry_of(joint.kind).coordinates;
  for (size_t k = 0; k < all.size(); ++k) {
    const CoordinateFrame& c = joint.coordinates[k];
    const std::string name(all[k].name);
    if (what == name) return c.value;
    if (all[k].angle && what == name + "_deg") return c.value * 180 / std::numbers::pi;
    if (what == name + "_rate" || (all.size() == 1 && what == "rate")) return c.rate;
    for (const std::string_view motor : {std::string_view("motor"), motor_of(all[k])})
      if (what == name + "_" + std::string(motor) || (all.size() == 1 && what == motor))
        return c.motor;
  }
  return {};
}

std::optional<double> joint_quantity(const BuiltScene& scene, const Frame& frame,
                                     std::string_view rest) {
  const auto [name, what] = split(rest);
  const auto found = scene.joints.find(name);
  if (found == scene.joints.end()) return {};
  const JointFrame* joint = nullptr;
  if (frame.joints)
    for (const JointFrame& j : *frame.joints)
      if (j.id == found->second) joint = &j;
  if (what == "broken") return joint ? 0 : 1;
  // A broken joint has no reaction and no coordinates.
  if (!joint) return what.starts_with("reaction") ? std::optional(0.0) : std::nullopt;
  const auto [vector, axis] = split(what);
  const Quat to_joint = joint->frame_a.q.conjugate();
  if (vector == "reaction") return component(to_joint * joint->mean_force, axis);
  if (vector == "reaction_torque") return component(to_joint * joint->mean_torque, axis);
  return coordinate_quantity(*joint, what);
}

std::optional<double> particle_quantity(const BuiltScene& scene, const Frame& frame,
                                        std::string_view rest) {
  const auto [name, what] = split(rest);
  const auto found = scene.particles.find(name);
  if (found == scene.particles.end()) return {};
  const auto system =
      std::ranges::find_if(frame.particles, [&](const auto& p) { return p->id == found->second; });
  if (system == frame.particles.end()) return {};
  const ParticleMeasures& m = (*system)->measures;
  const auto [vector, axis] = split(what);
  if (vector == "centre") return component(m.centre, axis);
  if (vector == "low") return component(m.low, axis);
  if (vector == "high") return component(m.high, axis);
  if (what == "count") return double(m.count);
  if (what == "speed") return m.speed;
  if (what == "max_speed") return m.max_speed;
  if (what == "temperature") return m.temperature;
  if (what == "pressure") return m.pressure;
  return {};
}

std::optional<double> sensor_quantity(const BuiltScene& scene, const Frame& frame,
                                      std::string_view rest) {
  const auto [name, what] = split(rest);
  const auto found = scene.sensors.find(name);
  if (found == scene.sensors.end() || !frame.sensors) return {};
  const auto sensor = std::ranges::find(*frame.sensors, found->second, &SensorFrame::id);
  if (sensor == frame.sensors->end()) return {};
  for (const SensorValue& v : sensor_values(*sensor))
    if (v.name == what) return v.value;
  const auto [holds, body] = split(what);
  if (sensor->kind != SensorKind::region || holds != "holds") return {};
  const auto id = scene.bodies.find(body);
  if (id == scene.bodies.end()) return {};
  return std::ranges::find(sensor->inside, id->second) != sensor->inside.end() ? 1 : 0;
}

/// Evaluates "", "work", "momentum.y", ... of a line of the ledger.
std::optional<double> entry_quantity(const LedgerEntry& e, std::string_view what) {
  if (what.empty()) return e.balance;
  if (what == "work") return e.work;
  const auto [vector, axis] = split(what);
  if (vector == "momentum") return component(e.momentum, axis);
  if (vector == "angular_momentum") return component(e.angular_momentum, axis);
  return {};
}

std::optional<double> ledger_quantity(const BuiltScene& scene, const Ledger& ledger,
                                      std::string_view rest) {
  auto [name, what] = split(rest);
  if (name == "forces") {
    std::tie(name, what) = split(what);
    const auto found = scene.forces.find(name);
    if (found == scene.forces.end()) return {};
    for (const ForceAccount& f : ledger.forces())
      if (f.id == found->second) return entry_quantity(f.account.total(), what);
    return entry_quantity({}, what);  // zero before the first tick
  }
  for (size_t i = 0; i < ledger_lines; ++i)
    if (ledger_line_name(LedgerLine(i)) == name)
      return entry_quantity(ledger.line(LedgerLine(i)).total(), what);
  return {};
}

}  // namespace

std::optional<double> quantity(const BuiltScene& scene, const Frame& frame, std::string_view name) {
  const StepStats& s = frame.stats;
  const std::array<std::pair<std::string_view, double>, 22> plain = {{
      {"time", frame.time},
      {"tick", double(frame.tick)},
      {"bodies", double(s.bodies)},
      {"awake", double(s.awake)},
      {"particles", double(s.particles)},
      {"islands", double(s.islands)},
      {"contacts", double(s.contacts)},
      {"contact_points", double(s.contact_points)},
      {"max_penetration", s.max_penetration},
      {"events", double(s.events)},
      {"impacts", double(s.impacts)},
      {"fallbacks", double(s.fallbacks)},
      {"time_stepped", double(s.time_stepped)},
      {"joints", double(s.joints)},
      {"broken_joints", double(s.broken_joints)},
      {"energy", s.energies.total()},
      {"energy.kinetic", s.energies.kinetic},
      {"energy.gravity", s.energies.gravity},
      {"energy.springs", s.energies.springs},
      {"energy.fields", s.energies.fields},
      {"energy.drift", frame.ledger ? frame.ledger->drift() : 0},
      {"energy.throughput", frame.ledger ? frame.ledger->throughput() : 0},
  }};
  for (const auto& [known, value] : plain)
    if (known == name) return value;
  const auto [head, rest] = split(name);
  if (head == "momentum") return component(s.momentum, rest);
  if (head == "angular_momentum") return component(s.angular_momentum, rest);
  if (head == "ledger" && frame.ledger) return ledger_quantity(scene, *frame.ledger, rest);
  if (head == "bodies") return body_quantity(scene, frame, rest);
  if (head == "joints") return joint_quantity(scene, frame, rest);
  if (head == "particles") return particle_quantity(scene, frame, rest);
  if (head == "sensors") return sensor_quantity(scene, frame, rest);
  return {};
}

std::optional<double> named_value(const BuiltScene& scene, const Frame& frame,
                                  std::string_view name) {
  if (const auto value = quantity(scene, frame, name)) return value;
  if (const auto* parameter = scene.description->parameters_.find(name)) return parameter->value;
  return std::nullopt;
}

std::shared_ptr<const BuiltScene> names_of(const BuiltScene& scene) {
  auto names = std::make_shared<BuiltScene>();
  names->description = scene.description;
  names->bodies = scene.bodies;
  names->joints = scene.joints;
  names->forces = scene.forces;
  names->particles = scene.particles;
  names->sensors = scene.sensors;
  return names;
}

std::string unit_of_quantity(std::string_view name) {
  if (name.find_first_of("+-*/%^() <>=&|!") != std::string_view::npos) return {};
  constexpr std::pair<std::string_view, std::string_view> units[] = {
      {".angular_velocity.", "rad/s"},
      {".angular_momentum.", "kg m2/s"},
      {".position.", "m"},
      {".velocity.", "m/s"},
      {".momentum.", "kg m/s"},
      {".reaction.", "N"},
      {".reaction_torque.", "N m"},
      {".fluid_force.", "N"},
      {".centre.", "m"},
      {".low.", "m"},
      {".high.", "m"},
      {".force", "N"}};
  if (name.starts_with("energy.drift")) return {};
  if (name == "time") return "s";
  if (name == "max_penetration") return "m";
  if (name.starts_with("momentum.")) return "kg m/s";
  if (name.starts_with("angular_momentum.")) return "kg m2/s";
  if (name.ends_with(".angular_speed")) return "rad/s";
  if (name.ends_with("speed")) return "m/s";
  if (name.ends_with(".mass")) return "kg";
  if (name.ends_with(".angle")) return "rad";
  if (name.ends_with("_deg")) return "deg";
  for (const auto& [part, unit] : units)
    if (name.find(part) != std::string_view::npos) return std::string(unit);
  if (name.starts_with("energy") || name.starts_with("ledger.")) return "J";
  return {};
}

std::string quantity_help() {
  return "time tick bodies awake particles islands contacts contact_points max_penetration\n"
         "  events impacts fallbacks time_stepped (of the event stepper, in the last tick)\n"
         "  joints (that there are) broken_joints (in the last tick)\n"
         "  energy energy.kinetic energy.gravity energy.springs energy.fields\n"
         "  energy.drift (error of the integrator / energy that went through all lines of the\n"
         "  ledger), energy.throughput; ledger.LINE (change of the energy by it), .work,\n"
         "  .momentum.x .y .z, .angular_momentum.x .y .z, with LINE forces.NAME or one of\n"
         "  gravity restitution friction kinematic joints motors sleeping projection offset\n"
         "  sph_pressure sph_viscosity sph_tension user emission removal edits past_forces "
         "integrator\n"
         "  momentum.x .y .z  angular_momentum.x .y .z\n"
         "  bodies.NAME.position.x .y .z, likewise .velocity .angular_velocity .up, and\n"
         "  .fluid_force .fluid_torque (of all fluids, mean of the last tick);\n"
         "  bodies.NAME.speed .angular_speed .mass .asleep\n"
         "  joints.NAME.angle .position ... (value of the coordinate of this name [rad, m]),\n"
         "  .angle_deg (a turn in degrees), .angle_rate, .angle_motor_torque\n"
         "  .position_motor_force (of its motor, mean of the last tick; also .angle_motor), or\n"
         "  .rate and .motor_torque .motor_force .motor where there is one coordinate;\n"
         "  .reaction.x .y .z and .reaction_torque.x .y .z\n"
         "  (on b, torque about the anchor, in the joint's frame on a) .broken (0 or 1)\n"
         "  particles.NAME.count .speed (root mean square) .max_speed .temperature (2/3 of a\n"
         "  particle's kinetic energy about the common motion) .pressure (mean, of a fluid), and\n"
         "  .centre.x .y .z (of mass), .low.x .y .z and .high.x .y .z (box about all centres)\n"
         "  sensors.NAME of a gate: .count .forward .backward .mass .mass_forward .mass_backward\n"
         "  .flow [kg/s]; of a region: .count .bodies .particles .mass .holds.BODY (0 or 1); of a\n"
         "  contact: .touching (0 or 1) .count (of touches) .force .force.x .y .z [N]";
}

namespace {

/// Adds things that exist now; a name keeps its meaning as long as the thing it refers to exists.
template <class Id>
void learn(std::map<std::string, Id, std::less<>>& names,
           const std::vector<std::pair<std::string_view, Id>>& there) {
  for (const auto& [name, id] : there) {
    if (name.empty()) continue;
    Id& known = names.try_emplace(std::string(name), id).first->second;
    const auto is_known = [&](const auto& other) { return other.second == known; };
    if (known != id && std::ranges::none_of(there, is_known)) known = id;
  }
}

}  // namespace

std::shared_ptr<const BuiltScene> names_with(const BuiltScene& names, const Frame& frame) {
  auto out = std::make_shared<BuiltScene>();
  out->description = names.description;
  out->bodies = names.bodies;
  out->joints = names.joints;
  out->forces = names.forces;
  out->particles = names.particles;
  out->sensors = names.sensors;
  std::vector<std::pair<std::string_view, BodyId>> bodies;
  for (size_t slot = 0; slot < frame.body_slots(); ++slot)
    if (const BodyId id = frame.body(slot).id; !id.is_null())
      bodies.emplace_back(frame.info(slot).name, id);
  learn(out->bodies, bodies);
  std::vector<std::pair<std::string_view, JointId>> joints;
  if (frame.joints)
    for (const JointFrame& joint : *frame.joints) joints.emplace_back(joint.name, joint.id);
  learn(out->joints, joints);
  std::vector<std::pair<std::string_view, ParticleSystemId>> particles;
  for (const auto& system : frame.particles) particles.emplace_back(system->name, system->id);
  learn(out->particles, particles);
  std::vector<std::pair<std::string_view, SensorId>> sensors;
  if (frame.sensors)
    for (const SensorFrame& sensor : *frame.sensors) sensors.emplace_back(sensor.name, sensor.id);
  learn(out->sensors, sensors);
  return out;
}

std::vector<std::string> joint_quantities(const JointFrame& joint) {
  const std::string head = "joints." + joint.name + ".";
  const std::vector<JointCoordinate>& all = entry_of(joint.kind).coordinates;
  std::vector<std::string> out;
  for (const JointCoordinate& c : all) {
    const std::string name = head + std::string(c.name), own = all.size() == 1 ? head : name + "_";
    out.insert(out.end(), {name, own + "rate", own + std::string(motor_of(c))});
  }
  for (const char* vector : {"reaction", "reaction_torque"})
    for (const char* axis : {".x", ".y", ".z"}) out.push_back(head + vector + axis);
  return out;
}

std::vector<std::string> quantity_names(const BuiltScene& scene) {
  return quantity_names(scene, *scene.world->frame());
}

std::vector<std::string> quantity_names(const BuiltScene& scene, const Frame& frame) {
  std::vector<std::string> out = {
      "time",          "tick",         "bodies",           "awake",           "particles",
      "islands",       "contacts",     "contact_points",   "max_penetration", "joints",
      "broken_joints", "energy",       "energy.kinetic",   "energy.gravity",  "energy.springs",
      "energy.fields", "energy.drift", "energy.throughput"};
  const auto axes = [&out](const std::string& vector) {
    for (const char* axis : {".x", ".y", ".z"}) out.push_back(vector + axis);
  };
  const auto line = [&](const std::string& name) {
    out.push_back(name);
    out.push_back(name + ".work");
    axes(name + ".momentum");
    axes(name + ".angular_momentum");
  };
  axes("momentum");
  axes("angular_momentum");
  for (size_t i = 0; i < ledger_lines; ++i)
    line("ledger." + std::string(ledger_line_name(LedgerLine(i))));
  for (const auto& [name, id] : scene.forces) line("ledger.forces." + name);
  for (const auto& [name, id] : scene.bodies) {
    for (const char* vector :
         {".position", ".velocity", ".angular_velocity", ".up", ".fluid_force", ".fluid_torque"})
      axes("bodies." + name + vector);
    for (const char* value : {".speed", ".angular_speed", ".mass", ".asleep"})
      out.push_back("bodies." + name + value);
  }
  for (const auto& [name, id] : scene.joints) {
    for (const char* vector : {".reaction", ".reaction_torque"}) axes("joints." + name + vector);
    out.push_back("joints." + name + ".broken");
    if (!frame.joints) continue;
    const auto joint = std::ranges::find(*frame.joints, id, &JointFrame::id);
    if (joint == frame.joints->end()) continue;
    for (const JointCoordinate& c : entry_of(joint->kind).coordinates)
      for (const std::string& what : {std::string(), std::string("_rate"), std::string("_motor"),
                                      "_" + std::string(motor_of(c))})
        out.push_back("joints." + name + "." + std::string(c.name) + what);
  }
  for (const auto& [name, id] : scene.particles) {
    for (const char* vector : {".centre", ".low", ".high"}) axes("particles." + name + vector);
    for (const char* value : {".count", ".speed", ".max_speed", ".temperature", ".pressure"})
      out.push_back("particles." + name + value);
  }
  if (frame.sensors)
    for (const SensorFrame& sensor : *frame.sensors)
      for (const SensorValue& v : sensor_values(sensor))
        out.push_back("sensors." + sensor.name + "." + std::string(v.name));
  return out;
}

}  // namespace tumble
