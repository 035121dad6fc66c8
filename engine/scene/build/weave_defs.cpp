#include "engine/scene/build/weave_defs.hpp"

#include "engine/scene/build/force_defs.hpp"
#include "engine/scene/build/named_order.hpp"
#include "engine/world/world.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The nodes to which a pin applies.
std::vector<std::pair<int, int>> pinned_nodes(const PinDescription& pin, int rows, int columns) {
  using enum PinPlace;
  const int last_row = rows - 1, last_column = columns - 1;
  std::vector<std::pair<int, int>> out;
  const auto row = [&](int r) {
    for (int c = 0; c < columns; c += pin.every) out.emplace_back(r, c);
  };
  const auto column = [&](int c) {
    for (int r = 0; r < rows; r += pin.every) out.emplace_back(r, c);
  };
  switch (pin.at) {
    case node:
      return {{pin.row, pin.column}};
    case top:
      row(0);
      return out;
    case bottom:
      row(last_row);
      return out;
    case left:
      column(0);
      return out;
    case right:
      column(last_column);
      return out;
    case corners:
      return {{0, 0}, {0, last_column}, {last_row, 0}, {last_row, last_column}};
    case top_left:
      return {{0, 0}};
    case top_right:
      return {{0, last_column}};
    case bottom_left:
      return {{last_row, 0}};
    case bottom_right:
      return {{last_row, last_column}};
  }
  return out;
}

Result<Sheet> sheet_of(const SheetDescription& d, const ParticleSystemDescription& system,
                       const BuiltScene& built) {
  Sheet out;
  out.corner = d.corner;
  out.across = d.across;
  out.down = d.down;
  out.columns = d.columns;
  out.rows = d.rows;
  out.damping_ratio = d.springs.damping_ratio;
  out.radius = d.radius;
  out.velocity = system.velocity;
  out.colour = out.second_colour = system.colour.linear();
  for (const PinDescription& pin : d.pins) {
    Anchor anchor;
    Pose frame;
    if (!pin.body.empty()) {
      const auto body = built.bodies.find(pin.body);
      if (body == built.bodies.end())
        return Error{ErrorCode::not_found, "there is no body '" + pin.body + "'", {}, {}};
      anchor.kind = Anchor::Kind::body;
      anchor.body = body->second;
      frame = built.world->body(body->second)->body_frame();
    }
    for (const auto& [row, column] : pinned_nodes(pin, d.rows, d.columns)) {
      const Vec3 x = d.corner + d.across * (double(column) / (d.columns - 1)) +
                     d.down * (double(row) / (d.rows - 1));
      anchor.point = frame.inverse_point(x);
      out.pins.push_back({row, column, anchor});
    }
  }
  return out;
}

/// Makes the weaves of a system.
struct Weaver {
  const ParticleSystemDescription& system;
  const BuiltScene& built;

  Result<Weave> operator()(const ClothDescription& d) const {
    ClothDef def;
    auto sheet = sheet_of(d.sheet, system, built);
    if (!sheet) return sheet.error();
    def.sheet = std::move(*sheet);
    if (d.second_colour) def.sheet.second_colour = d.second_colour->linear();
    def.sheet.stripe = d.stripe;
    def.density = d.density;
    def.stretch = d.stretch;
    def.shear = d.shear;
    def.bend = d.bend;
    return weave_cloth(def);
  }
  Result<Weave> operator()(const NetDescription& d) const {
    NetDef def;
    auto sheet = sheet_of(d.sheet, system, built);
    if (!sheet) return sheet.error();
    def.sheet = std::move(*sheet);
    def.density = d.density;
    def.stiffness = d.stiffness;
    def.thread_radius = d.thread_radius;
    return weave_net(def);
  }
  Result<Weave> operator()(const RopeDescription& d) const {
    RopeDef def;
    for (const RopePlaceDescription& place : d.path)
      if (const Status added = add_place(place, def.places); !added) return added.error();
    def.segments = d.segments;
    def.slack = d.slack;
    def.density = d.density;
    def.stiffness = d.stiffness;
    def.bend = d.bend;
    def.damping_ratio = d.springs.damping_ratio;
    def.radius = d.radius;
    def.velocity = system.velocity;
    def.colour = system.colour.linear();
    const Vec3 g = built.world->settings().gravity.now();
    if (g.norm() > 0) def.down = g;
    return weave_rope(def);
  }

 private:
  Status add_place(const RopePlaceDescription& place, std::vector<RopeDef::Place>& out) const {
    const auto add = [&](const Anchor& anchor) {
      out.push_back({place.loose, anchor, start_of(anchor, *built.world)});
    };
    const std::string& body = place.anchor.body;
    if (body.empty() || built.bodies.contains(body)) {
      const auto anchor = anchor_of(place.anchor, built);
      if (!anchor) return anchor.error();
      add(*anchor);
      return {};
    }
    const std::vector<BodyId> copies = bodies_named(body, built);
    if (copies.empty())
      return Error{ErrorCode::not_found, "there is no body '" + body + "'", {}, {}};
    for (const BodyId id : copies) {
      Anchor anchor;
      anchor.kind = Anchor::Kind::body;
      anchor.body = id;
      anchor.point = place.anchor.point;
      add(anchor);
    }
    return {};
  }
};

double strain_of(const RopeDescription& d) {
  return d.springs.break_strain;
}
double strain_of(const auto& sheet) {
  return sheet.sheet.springs.break_strain;
}

/// Number of nodes; checked before any memory is allocated.
double nodes_of(const RopeDescription& d) {
  return double(d.segments) * double(d.path.size());
}
double nodes_of(const auto& sheet) {
  return double(sheet.sheet.rows) * sheet.sheet.columns;
}

}  // namespace

std::vector<std::string> systems_on_ropes(const ParticleSystemDescription& system) {
  std::vector<std::string> out;
  for (const RopeDescription& rope : system.rope)
    for (const RopePlaceDescription& place : rope.path)
      if (!place.anchor.particles.empty()) out.push_back(place.anchor.particles);
  return out;
}

Result<std::vector<std::string>> particle_order(const SceneDescription& scene) {
  NamedOrder out([&](const std::string& name) {
    const ParticleSystemDescription* system = scene.particles.find(name);
    return system ? systems_on_ropes(*system) : std::vector<std::string>{};
  });
  for (const auto& [name, system] : scene.particles.items)
    if (!out.add(name))
      return Error{
          ErrorCode::invalid_argument,
          "ropes lead from this particle system back to it, so that none could be the first",
          "particles." + name, "lead a rope of one of them through bodies or points"};
  std::erase_if(out.order, [&](const std::string& name) { return !scene.particles.find(name); });
  return std::move(out.order);
}

Result<std::vector<WaitingWeave>> add_weaves(const std::string& name,
                                             const ParticleSystemDescription& system, double budget,
                                             const BuiltScene& built, ParticleSystemDef& out) {
  std::vector<WaitingWeave> waiting;
  const Weaver weaver{system, built};
  const auto add = [&](const auto& list, std::string_view key) -> Status {
    for (size_t i = 0; i < list.size(); ++i) {
      const std::string one = list.size() > 1 ? fmt::format("{}[{}]", key, i) : std::string(key);
      const std::string place = fmt::format("particles.{}.{}[{}]", name, key, i);
      if (double(out.particles.size()) + nodes_of(list[i]) > budget)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("there may be {:.0f} particles in all", max_particles),
                     place,
                     {}};
      auto weave = weaver(list[i]);
      if (!weave) return Error{weave.error().code, weave.error().message, place, {}};
      WaitingWeave w{name, name + "." + one, std::move(*weave), 1 + out.particles.size(),
                     strain_of(list[i])};
      out.particles.insert(out.particles.end(), w.weave.particles.begin(), w.weave.particles.end());
      waiting.push_back(std::move(w));
    }
    return {};
  };
  for (const Status& done :
       {add(system.cloth, "cloth"), add(system.net, "net"), add(system.rope, "rope")})
    if (!done) return done.error();
  if (waiting.empty() || (!out.fluid && !out.grains && !out.fast)) return waiting;
  return Error{
      ErrorCode::invalid_argument,
      "cloths, nets and ropes are of ordinary particles (leave out fluid, grains and fast)",
      "particles." + name,
      {}};
}

}  // namespace tumble
