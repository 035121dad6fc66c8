#include "viewer/render/overlays.hpp"

#include "engine/core/registry.hpp"

namespace tumble {

const std::vector<OverlayEntry>& all_overlays() {
  static const std::vector<OverlayEntry> entries = {
      {"contacts", "contact points, red where bodies overlap", &Overlays::contacts},
      {"normals", "contact normals, from the first body to the second", &Overlays::normals},
      {"forces", "contact forces of the last tick", &Overlays::forces},
      {"aabbs", "bounding boxes of the bodies", &Overlays::aabbs},
      {"grid", "cells or boxes of the broad phase, a colour for each level", &Overlays::grid},
      {"joints", "springs and their anchors", &Overlays::joints},
      {"velocities", "velocities of the centres of mass", &Overlays::velocities},
      {"collision_shape", "the geometry that collides, as wires", &Overlays::collision_shape},
      {"islands", "a colour for each group of touching bodies, dark where asleep",
       &Overlays::islands},
  };
  return entries;
}

Result<Overlays> parse_overlays(std::string_view text) {
  Overlays overlays;
  while (!text.empty()) {
    const size_t comma = text.find(',');
    const std::string_view name = text.substr(0, comma);
    text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
    if (name.empty() || name == "none") continue;
    const auto entry = find_named(all_overlays(), name, "overlay");
    if (!entry) return entry.error();
    overlays.*((*entry)->enabled) = true;
  }
  return overlays;
}

}  // namespace tumble
