#include "engine/scene/build/sensor_defs.hpp"

#include "engine/scene/build/ids_of_name.hpp"
#include "engine/scene/repetition.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

/// The body with a name that may contain an expression in i; null for "".
Result<BodyId> counted_body(const std::string& name, int i, const BuiltScene& built) {
  if (name.empty()) return BodyId{};
  const auto counted = counted_name(name, i);
  if (!counted) return counted.error();
  const auto found = built.bodies.find(*counted);
  if (found == built.bodies.end())
    return Error{ErrorCode::not_found, "'" + *counted + "' is not present", {}, {}};
  return found->second;
}

struct SensorMaker {
  const BuiltScene& built;
  int i = 0;
  Vec3 shift = Vec3::Zero();

  Status place(SensorDef& out, const SensorTarget& target) const {
    const auto carrier = counted_body(target.body, i, built);
    if (!carrier) return carrier.error();
    out.carrier = *carrier;
    out.pose = target.placement.pose();
    out.pose.x += shift;
    out.bodies = target.takes != SensorTakes::particles;
    out.particles = target.takes != SensorTakes::bodies;
    for (const std::string& name : target.bodies) add_ids(built.bodies, name, out.only_bodies);
    return systems(out, target.particles);
  }
  Status systems(SensorDef& out, const std::vector<std::string>& names) const {
    for (const std::string& name : names) {
      const auto found = built.particles.find(name);
      if (found == built.particles.end())
        return Error{ErrorCode::not_found, "there is no particle system '" + name + "'", {}, {}};
      out.only_systems.push_back(found->second);
    }
    return {};
  }

  Status fill(SensorDef& out, const GateDescription& d) const {
    out.kind = SensorKind::gate;
    out.shape = d.shape();
    out.span = d.span;
    return place(out, d.target);
  }
  Status fill(SensorDef& out, const RegionDescription& d) const {
    out.kind = SensorKind::region;
    out.shape = d.shape();
    return place(out, d.target);
  }
  Status fill(SensorDef& out, const RadialDescription& d) const {
    out.kind = SensorKind::radial;
    out.range = d.range;
    out.shells = uint32_t(d.shells);
    return systems(out, d.particles);
  }
  Status fill(SensorDef& out, const ContactSensorDescription& d) const {
    out.kind = SensorKind::contact;
    const auto a = counted_body(d.a, i, built), b = counted_body(d.b, i, built);
    if (!a || !b) return a ? b.error() : a.error();
    out.a = *a;
    out.b = *b;
    return {};
  }
};

}  // namespace

Result<std::vector<SensorDef>> sensor_defs(const std::string& name, const SensorDescription& d,
                                           const BuiltScene& built) {
  std::vector<SensorDef> out;
  for (int i = 0; i < d.count; ++i) {
    SensorDef& def = out.emplace_back();
    def.name = d.count == 1 ? name : fmt::format("{}[{}]", name, i);
    const SensorMaker maker{built, i, i * d.step};
    const Status filled =
        std::visit([&](const auto& kind) { return maker.fill(def, kind); }, d.kind);
    if (!filled) return filled.error();
  }
  return out;
}

}  // namespace tumble
