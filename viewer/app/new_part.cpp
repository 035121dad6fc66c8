#include "viewer/app/new_part.hpp"

#include "engine/math/rotation.hpp"

namespace tumble {
namespace {

using Named = std::pair<std::string, PartDescription>;

/// y along the normal.
void stand_on(Placement& placement, const Vec3& at, const Vec3& normal) {
  placement.position = at;
  const Vec3 angles = quat_to_euler_deg(rotation_between(Vec3::UnitY(), normal));
  if (!angles.isZero(1e-9)) placement.euler_deg = angles;
}

/// A square that lies flat, with its middle above the place.
SheetDescription sheet_above(const PartPlace& place) {
  constexpr int nodes = 31;
  SheetDescription sheet;
  const double side = 2 * place.size;
  sheet.corner = place.at + Vec3(-0.5 * side, 0.5 * place.size, -0.5 * side);
  sheet.across = Vec3(side, 0, 0);
  sheet.down = Vec3(0, 0, side);
  sheet.columns = sheet.rows = nodes;
  sheet.springs.damping_ratio = 0.3;
  return sheet;
}

std::vector<Named> new_emitter(const PartPlace& place, const SceneDescription& parts) {
  std::vector<Named> out;
  EmitterDescription emitter;
  // One after the other, none into the one before.
  stand_on(emitter.placement, place.at + 4 * place.size * place.normal, place.normal);
  emitter.at_most = 100;
  if (place.body.empty()) {
    ParticleSystemDescription spray;
    spray.radius = 0.05 * place.size;
    spray.mass = 4000 * spray.radius * spray.radius * spray.radius;
    spray.colour = {0.2, 0.55, 0.9};
    const std::string name = new_part_name(parts, "particles", "spray");
    emitter.particles = name;
    stand_on(emitter.placement, place.at + 0.2 * place.size * place.normal, place.normal);
    emitter.rate = 40;
    emitter.at_most = 400;
    emitter.spread_deg = 10;
    emitter.speed.number.mean = 6 * std::sqrt(place.size);
    emitter.life = RandomNumberDescription{};
    emitter.life->number.mean = 6;
    out.emplace_back(name, std::move(spray));
  } else {
    emitter.body = place.body;
    emitter.rate = 2;
  }
  out.emplace_back(new_part_name(parts, "emitters", "emitter"), std::move(emitter));
  return out;
}

}  // namespace

std::vector<Named> new_parts(PartKind kind, const PartPlace& place, const SceneDescription& parts) {
  const auto one = [&](const char* list, const char* base, PartDescription part) {
    std::vector<Named> out;
    out.emplace_back(new_part_name(parts, list, base), std::move(part));
    return out;
  };
  ParticleSystemDescription system;
  SensorDescription sensor;
  switch (kind) {
    case PartKind::emitter:
      return new_emitter(place, parts);
    case PartKind::cloth: {
      ClothDescription cloth;
      cloth.sheet = sheet_above(place);
      cloth.density = 0.25;
      cloth.second_colour = Colour{0.94, 0.89, 0.81};
      cloth.stripe = 3;
      system.friction = 0.6;
      system.colour = {0.7, 0.23, 0.28};
      system.cloth.push_back(cloth);
      return one("particles", "cloth", system);
    }
    case PartKind::net: {
      NetDescription net;
      net.sheet = sheet_above(place);
      net.sheet.columns = net.sheet.rows = 16;
      net.thread_radius = 0.02 * place.size;
      system.friction = 0.6;
      system.colour = {0.85, 0.72, 0.45};
      system.net.push_back(net);
      return one("particles", "net", system);
    }
    case PartKind::heap: {
      LatticeFill fill;
      fill.size = Vec3::Constant(place.size);
      fill.spacing = 0.2 * place.size;
      fill.centre = place.at + 1.5 * place.size * place.normal;
      system.radius = 0.09 * place.size;
      system.mass = 4000 * system.radius * system.radius * system.radius;
      system.colour = {0.9, 0.7, 0.2};
      system.fill.push_back({fill});
      return one("particles", "heap", system);
    }
    case PartKind::gate: {
      GateDescription gate;
      gate.size = {place.size, place.size};
      stand_on(gate.target.placement, place.at + 0.5 * place.size * place.normal, place.normal);
      sensor.kind = gate;
      return one("sensors", "gate", sensor);
    }
    case PartKind::region: {
      RegionDescription region;
      region.size = {place.size, place.size, place.size};
      stand_on(region.target.placement, place.at + 0.5 * place.size * place.normal, place.normal);
      sensor.kind = region;
      return one("sensors", "region", sensor);
    }
  }
  return {};
}

}  // namespace tumble
