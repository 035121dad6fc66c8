#include "viewer/render/overlays.hpp"

#include "engine/core/registry.hpp"
#include "engine/core/text.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "engine/world/frame.hpp"
#include "viewer/render/extract_vectors.hpp"
#include "viewer/render/overlay_colours.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Whether any field is a flow, or an acceleration.
template <bool flow>
bool has_fields(const Frame& frame) {
  return std::any_of(frame.forces.begin(), frame.forces.end(), [&](const ForceFrame& force) {
    const auto sample = sample_field(force.def, Vec3::Zero(), frame.time);
    return sample && sample->flow == flow;
  });
}

bool has_bodies(const Frame& frame) {
  return frame.stats.bodies > 0;
}
bool has_particles(const Frame& frame) {
  return std::ranges::any_of(frame.particles, [](const auto& p) { return !p->x.empty(); });
}

bool has_sensors(const Frame& frame) {
  return frame.sensors != nullptr;
}

}  // namespace

const std::vector<OverlayEntry>& all_overlays() {
  namespace colour = overlay_colour;
  static const std::vector<OverlayEntry> entries = {
      {"contacts",
       "contact points, red where bodies overlap",
       &Overlays::contacts,
       {{colour::contact, "contact"}, {colour::overlap, "contact with overlap"}}},
      {"normals",
       "contact normals, from the first body to the second",
       &Overlays::normals,
       {{colour::normal, "contact normal"}}},
      {"forces",
       "contact forces of the last tick, and fields as arrows",
       &Overlays::forces,
       {{colour::force, "contact force on the second body"},
        {colour::pull, "acceleration by a field", &has_fields<false>},
        {colour::flow, "flow of a field", &has_fields<true>}}},
      {"friction_cones",
       "friction cones and the force within: green sticks, red slides",
       &Overlays::friction_cones,
       {{colour::sticks, "friction cone: sticks"}, {colour::slides, "friction cone: slides"}}},
      {"aabbs",
       "bounding boxes of the bodies",
       &Overlays::aabbs,
       {{colour::bounds, "bounding box"}}},
      {"grid", "cells or boxes of the broad phase, a colour for each level", &Overlays::grid, {}},
      {"joints",
       "joints with their frames, anchors of springs",
       &Overlays::joints,
       {{colour::anchor, "joint or anchor, on the first body"},
        {colour::contact, "joint, on the second body"},
        {colour::axes[0], "x axis of a joint"},
        {colour::axes[1], "y axis of a joint"},
        {colour::axes[2], "z axis of a joint"}}},
      {"velocities",
       "velocities of the centres of mass, and of particles",
       &Overlays::velocities,
       {{colour::velocity, "velocity", &has_bodies, &velocity_scale},
        {colour::velocity, "velocity of particles", &has_particles, &particle_velocity_scale}}},
      {"momenta",
       "momenta of the bodies, and of particles to a scale of their own",
       &Overlays::momenta,
       {{colour::momentum, "momentum", &has_bodies, &momentum_scale},
        {colour::momentum, "momentum of particles", &has_particles, &particle_momentum_scale}}},
      {"total_forces",
       "total forces on the bodies, contacts and joints included, in the mean of the last tick",
       &Overlays::total_forces,
       {{colour::total_force, "total force, mean of the last tick", nullptr, &force_scale_words}}},
      {"collision_shape",
       "the geometry that collides, as wires",
       &Overlays::collision_shape,
       {{colour::wire, "collision shape"}}},
      {"islands",
       "a colour for each group of touching bodies, dark where asleep",
       &Overlays::islands,
       {}},
      {"hierarchy",
       "a level of the tree of volumes around meshes; hierarchy:obb:4 says which",
       &Overlays::hierarchy,
       {}},
      {"sensors",
       "gates, regions and contacts that the scene measures, with what they say",
       &Overlays::sensors,
       {{colour::sensor, "sensor: nothing in it", &has_sensors},
        {colour::sensing, "sensor: something in it, or touching", &has_sensors}}},
  };
  return entries;
}

const std::vector<std::string>& drawn_hierarchies() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const HierarchyKind& kind : all_hierarchies())
      if (kind.name != "brute_force") out.emplace_back(kind.name);
    return out;
  }();
  return names;
}

namespace {

/// What stands after the name of an overlay, e.g. "obb:4".
Status parse_hierarchy(std::string_view text, Overlays& overlays) {
  while (!text.empty()) {
    const size_t colon = text.find(':');
    const std::string part(text.substr(0, colon));
    text = colon == std::string_view::npos ? std::string_view{} : text.substr(colon + 1);
    const auto& kinds = drawn_hierarchies();
    if (std::find(kinds.begin(), kinds.end(), part) != kinds.end()) {
      overlays.hierarchy_kind = part;
    } else if (!part.empty() && part.size() <= 3 &&
               part.find_first_not_of("0123456789") == std::string::npos) {
      overlays.hierarchy_level = std::stoi(part);
    } else {
      return Error{ErrorCode::invalid_argument,
                   unknown_name("kind of hierarchy", part, kinds) + ", nor a level",
                   "overlay hierarchy", "e.g. hierarchy:obb:4"};
    }
  }
  return {};
}

}  // namespace

Result<Overlays> parse_overlays(std::string_view text) {
  Overlays overlays;
  while (!text.empty()) {
    const size_t comma = text.find(',');
    std::string_view name = text.substr(0, comma);
    text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
    if (name.empty() || name == "none") continue;
    const size_t colon = name.find(':');
    if (colon != std::string_view::npos && name.substr(0, colon) == "hierarchy") {
      if (Status s = parse_hierarchy(name.substr(colon + 1), overlays); !s) return s.error();
      name = name.substr(0, colon);
    }
    const auto entry = find_named(all_overlays(), name, "overlay");
    if (!entry) return entry.error();
    overlays.*((*entry)->enabled) = true;
  }
  return overlays;
}

}  // namespace tumble
