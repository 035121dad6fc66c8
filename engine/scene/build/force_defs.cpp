#include "engine/scene/build/force_defs.hpp"

#include "engine/scene/build/ids_of_name.hpp"
#include "engine/scene/build/near_pairs.hpp"
#include "engine/world/world.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

struct ForceMaker {
  const BuiltScene& built;

  template <class Def>
  Result<ForceDef> operator()(const Def& d) const {
    return ForceDef(d);
  }
  template <class Def>
  Result<ForceDef> operator()(const FieldDescription<Def>& d) const {
    Def out = d.field;
    for (const std::string& name : d.bodies) add_ids(built.bodies, name, out.targets.bodies);
    for (const std::string& name : d.particles)
      add_ids(built.particles, name, out.targets.particles);
    const bool named = !d.bodies.empty() || !d.particles.empty();
    if (named && out.targets.everything())
      return Error{ErrorCode::not_found, "nothing of what it acts on is present", {}, {}};
    return ForceDef(out);
  }
  template <class Def>
  Result<ForceDef> operator()(const PairDescription<Def>& d) const {
    Def out = d.force;
    for (const std::string& name : d.between) add_ids(built.particles, name, out.between);
    if (!d.between.empty() && out.between.empty())
      return Error{ErrorCode::not_found, "none of the particle systems is present", {}, {}};
    return ForceDef(out);
  }
  Result<ForceDef> operator()(const SpringDescription& d) const {
    const auto a = anchor_of(d.a, built), b = anchor_of(d.b, built);
    if (!a) return a.error();
    if (!b) return b.error();
    SpringDef out;
    out.a = *a;
    out.b = *b;
    out.stiffness = d.stiffness;
    out.damping = d.damping;
    out.cable_radius = d.cable_radius;
    out.rest_length =
        d.rest_length ? *d.rest_length
                      : Varying((start_of(*a, *built.world) - start_of(*b, *built.world)).norm());
    return ForceDef(out);
  }
  template <class Def>
  Result<ForceDef> operator()(const AnchoredDescription<Def>& d) const {
    const auto a = anchor_of(d.anchor, built);
    if (!a) return a.error();
    Def out = d.force;
    out.anchor = *a;
    return ForceDef(out);
  }
};

}  // namespace

Result<Anchor> anchor_of(const AnchorDescription& d, const BuiltScene& built) {
  Anchor out;
  out.point = d.point;
  if (!d.body.empty()) {
    const auto it = built.bodies.find(d.body);
    if (it == built.bodies.end())
      return Error{ErrorCode::not_found, "there is no body '" + d.body + "'", {}, {}};
    out.kind = Anchor::Kind::body;
    out.body = it->second;
  } else if (!d.particles.empty()) {
    const auto it = built.particles.find(d.particles);
    if (it == built.particles.end())
      return Error{
          ErrorCode::not_found, "there is no particle system '" + d.particles + "'", {}, {}};
    const ParticleSystem* system = built.world->particles(it->second);
    if (!system || size_t(d.index) >= system->size())
      return Error{ErrorCode::not_found,
                   "'" + d.particles + "' has no particle " + std::to_string(d.index),
                   {},
                   {}};
    out.kind = Anchor::Kind::particle;
    out.particles = it->second;
    out.particle = system->id[size_t(d.index)];
  }
  return out;
}

Vec3 start_of(const Anchor& a, const World& world) {
  if (a.kind == Anchor::Kind::body)
    if (const RigidBody* body = world.body(a.body)) return body->body_frame().point(a.point);
  if (a.kind == Anchor::Kind::particle)
    if (const ParticleSystem* s = world.particles(a.particles)) return s->x[s->find(a.particle)];
  return a.point;
}

std::vector<BodyId> bodies_named(const std::string& name, const BuiltScene& built) {
  std::vector<BodyId> out;
  add_ids(built.bodies, name, out);
  return out;
}

Result<std::vector<SpringDef>> neighbour_springs(const NeighbourSpringsDescription& springs,
                                                 ParticleSystemId id,
                                                 const ParticleSystem& system) {
  constexpr size_t most = 100'000;
  const auto pairs = near_pairs(system.x, springs.reach, most);
  if (!pairs)
    return Error{ErrorCode::invalid_argument,
                 fmt::format("more than {} springs between neighbours; so many are made at most "
                             "(a shorter reach makes fewer)",
                             most),
                 {},
                 {}};
  std::vector<SpringDef> out;
  for (const auto& [a, b] : *pairs) {
    SpringDef& s = out.emplace_back();
    s.a.kind = s.b.kind = Anchor::Kind::particle;
    s.a.particles = s.b.particles = id;
    s.a.particle = system.id[a], s.b.particle = system.id[b];
    s.stiffness = springs.stiffness;
    s.damping = springs.damping;
    s.rest_length = springs.rest * (system.x[a] - system.x[b]).norm();
    s.cable_radius = springs.cable_radius;
  }
  return out;
}

Result<ForceDef> force_def(const ForceDescription& force, const BuiltScene& built) {
  return std::visit(ForceMaker{built}, force.kind);
}

}  // namespace tumble
