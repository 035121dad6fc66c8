#include "engine/scene/quantities.hpp"

#include "engine/math/det/det.hpp"

#include <algorithm>

namespace tumble {
namespace {

using Value = std::optional<double>;

/// Takes `head` off the front of `name` when it is there.
bool take(std::string_view& name, std::string_view head) {
  if (!name.starts_with(head)) return false;
  name.remove_prefix(head.size());
  return true;
}

Value component(const Vec3& v, std::string_view axis) {
  if (axis == "x") return v.x();
  if (axis == "y") return v.y();
  if (axis == "z") return v.z();
  return std::nullopt;
}

Value of_body(const BodyFrame& body, const BodyInfo& info, std::string_view what) {
  if (take(what, "position.")) return component(body.pose.x, what);
  if (take(what, "velocity.")) return component(body.v, what);
  if (take(what, "angular_velocity.")) return component(body.omega, what);
  if (what == "orientation.w") return body.pose.q.w();
  if (take(what, "orientation.")) return component(body.pose.q.vec(), what);
  if (what == "speed") return body.v.norm();
  if (what == "angular_speed") return body.omega.norm();
  if (what == "mass") return info.mass;
  if (what == "asleep") return body.asleep ? 1 : 0;
  if (what == "tilt_deg") {
    const double up = body.pose.direction(Vec3::UnitY()).y();
    return det::acos(std::clamp(up, -1.0, 1.0)) * (180 / det::pi);
  }
  return std::nullopt;
}

/// "ball.position.y": the name is what stands before the first dot.
Value of_bodies(const Frame& frame, std::string_view rest) {
  const size_t dot = rest.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const std::string_view name = rest.substr(0, dot);
  for (size_t slot = 0; slot < frame.body_slots(); ++slot)
    if (frame.body(slot).id && frame.info(slot).name == name)
      return of_body(frame.body(slot), frame.info(slot), rest.substr(dot + 1));
  return std::nullopt;
}

Value of_frame(const Frame& frame, std::string_view name) {
  const StepStats& s = frame.stats;
  if (take(name, "bodies.")) return of_bodies(frame, name);
  if (take(name, "momentum.")) return component(s.momentum, name);
  if (take(name, "angular_momentum.")) return component(s.angular_momentum, name);
  const std::pair<std::string_view, double> scalars[] = {
      {"time", frame.time},
      {"tick", double(frame.tick)},
      {"energy.kinetic", s.energies.kinetic},
      {"energy.gravity", s.energies.gravity},
      {"energy.springs", s.energies.springs},
      {"energy.total", s.energies.total()},
      {"contacts", double(s.contacts)},
      {"contact_points", double(s.contact_points)},
      {"pairs", double(s.pairs)},
      {"islands", double(s.islands)},
      {"awake", double(s.awake)},
      {"bodies", double(s.bodies)},
      {"particles", double(s.particles)},
      {"max_penetration", s.max_penetration}};
  for (const auto& [known, value] : scalars)
    if (known == name) return value;
  return std::nullopt;
}

}  // namespace

NameLookup world_quantities(std::shared_ptr<const Frame> now,
                            std::shared_ptr<const Frame> initial) {
  return [now = std::move(now), initial = std::move(initial)](std::string_view name) -> Value {
    if (take(name, "initial.")) return initial ? of_frame(*initial, name) : std::nullopt;
    return of_frame(*now, name);
  };
}

}  // namespace tumble
