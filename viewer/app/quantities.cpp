#include "viewer/app/quantities.hpp"

#include <array>
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
  if (vector == "up") return component(body.pose.direction(Vec3::UnitY()), axis);
  if (what == "speed") return body.v.norm();
  if (what == "angular_speed") return body.omega.norm();
  if (what == "mass") return frame.info(found->second.index).mass;
  if (what == "asleep") return body.asleep ? 1 : 0;
  return {};
}

}  // namespace

std::optional<double> quantity(const BuiltScene& scene, const Frame& frame, std::string_view name) {
  const StepStats& s = frame.stats;
  const std::array<std::pair<std::string_view, double>, 12> plain = {{
      {"time", frame.time},
      {"tick", double(frame.tick)},
      {"bodies", double(s.bodies)},
      {"awake", double(s.awake)},
      {"islands", double(s.islands)},
      {"contacts", double(s.contacts)},
      {"contact_points", double(s.contact_points)},
      {"max_penetration", s.max_penetration},
      {"energy", s.energies.total()},
      {"energy.kinetic", s.energies.kinetic},
      {"energy.gravity", s.energies.gravity},
      {"energy.springs", s.energies.springs},
  }};
  for (const auto& [known, value] : plain)
    if (known == name) return value;
  const auto [head, rest] = split(name);
  if (head == "momentum") return component(s.momentum, rest);
  if (head == "angular_momentum") return component(s.angular_momentum, rest);
  if (head == "bodies") return body_quantity(scene, frame, rest);
  return {};
}

std::string quantity_help() {
  return "time tick bodies awake islands contacts contact_points max_penetration\n"
         "  energy energy.kinetic energy.gravity energy.springs\n"
         "  momentum.x .y .z  angular_momentum.x .y .z\n"
         "  bodies.NAME.position.x .y .z, likewise .velocity .angular_velocity .up, and\n"
         "  bodies.NAME.speed .angular_speed .mass .asleep";
}

}  // namespace tumble
