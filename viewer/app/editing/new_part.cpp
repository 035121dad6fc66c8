#include "viewer/app/editing/new_part.hpp"

#include "engine/math/rotation.hpp"

#include <cmath>

namespace tumble {
namespace {

using Named = std::pair<std::string, PartDescription>;

/// Orients the placement with y along the normal.
void stand_on(Placement& placement, const Vec3& at, const Vec3& normal) {
  placement.position = at;
  const Vec3 angles = quat_to_euler_deg(rotation_between(Vec3::UnitY(), normal));
  if (!angles.isZero(1e-9)) placement.euler_deg = angles;
}

/// A horizontal square sheet with its centre above the place.
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
  // Bodies are emitted one after the other, so that none overlaps the one before.
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

ParticleSystemDescription new_cloth(const PartPlace& place) {
  ParticleSystemDescription system;
  ClothDescription& cloth = system.cloth.emplace_back();
  cloth.sheet = sheet_above(place);
  cloth.density = 0.25;
  cloth.second_colour = Colour{0.94, 0.89, 0.81};
  cloth.stripe = 3;
  system.friction = 0.6;
  system.colour = {0.7, 0.23, 0.28};
  return system;
}

ParticleSystemDescription new_net(const PartPlace& place) {
  ParticleSystemDescription system;
  NetDescription& net = system.net.emplace_back();
  net.sheet = sheet_above(place);
  net.sheet.columns = net.sheet.rows = 16;
  net.thread_radius = 0.02 * place.size;
  system.friction = 0.6;
  system.colour = {0.85, 0.72, 0.45};
  return system;
}

ParticleSystemDescription new_heap(const PartPlace& place) {
  ParticleSystemDescription system;
  LatticeFill fill;
  fill.size = Vec3::Constant(place.size);
  fill.spacing = 0.2 * place.size;
  fill.centre = place.at + 1.5 * place.size * place.normal;
  system.radius = 0.09 * place.size;
  system.mass = 4000 * system.radius * system.radius * system.radius;
  system.colour = {0.9, 0.7, 0.2};
  system.fill.push_back({fill});
  return system;
}

/// A block of water, three spacings above the surface below it.
ParticleSystemDescription new_fluid(const PartPlace& place) {
  ParticleSystemDescription system;
  LatticeFill fill;
  fill.size = Vec3::Constant(1.5 * place.size);
  fill.spacing = 0.1 * place.size;
  fill.centre = place.at + (0.75 + 0.1) * place.size * place.normal;
  system.fluid.emplace();
  system.look.style = ParticleStyle::surface;
  system.colour = {0.25, 0.56, 0.82};
  system.fill.push_back({fill});
  return system;
}

SensorDescription new_gate(const PartPlace& place) {
  GateDescription gate;
  gate.size = {place.size, place.size};
  stand_on(gate.target.placement, place.at + 0.5 * place.size * place.normal, place.normal);
  return {gate};
}

SensorDescription new_region(const PartPlace& place) {
  RegionDescription region;
  region.size = {place.size, place.size, place.size};
  stand_on(region.target.placement, place.at + 0.5 * place.size * place.normal, place.normal);
  return {region};
}

/// One part and its name; emitters may add a second one.
template <auto make>
std::vector<Named> alone(const char* base, const PartPlace& place, const SceneDescription& parts) {
  const PartDescription part = make(place);
  return {{new_part_name(parts, list_of(part), base), part}};
}
std::vector<Named> emitting(const char*, const PartPlace& place, const SceneDescription& parts) {
  return new_emitter(place, parts);
}

struct Kind {
  PartKind kind;
  const char* base;  ///< of the name
  std::vector<Named> (*make)(const char* base, const PartPlace&, const SceneDescription&);
};
constexpr Kind kinds[] = {
    {PartKind::emitter, "emitter", emitting},       {PartKind::cloth, "cloth", alone<new_cloth>},
    {PartKind::net, "net", alone<new_net>},         {PartKind::heap, "heap", alone<new_heap>},
    {PartKind::fluid, "fluid", alone<new_fluid>},   {PartKind::gate, "gate", alone<new_gate>},
    {PartKind::region, "region", alone<new_region>}};

}  // namespace

std::vector<Named> new_parts(PartKind kind, const PartPlace& place, const SceneDescription& parts) {
  for (const Kind& k : kinds)
    if (k.kind == kind) return k.make(k.base, place, parts);
  return {};
}

}  // namespace tumble
