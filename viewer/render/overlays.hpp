#pragma once
#include "engine/core/result.hpp"
#include "engine/math/types.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

struct Frame;

/// What is drawn on top of the bodies to see how they are computed.
struct Overlays {
  bool contacts = false;
  bool normals = false;
  bool forces = false;
  bool friction_cones = false;
  bool aabbs = false;
  bool grid = false;
  bool joints = false;
  bool velocities = false;
  bool momenta = false;
  bool total_forces = false;
  bool collision_shape = false;
  bool islands = false;
  bool hierarchy = false;
  bool sensors = false;

  /// Which volumes the hierarchy shows: kind of tree ("": that of the world), levels below its
  /// root.
  std::string hierarchy_kind;
  int hierarchy_level = 3;
  /// Arrows of velocity, momentum and total force are so many times as long as usual.
  double vector_length = 1;
};

/// What a colour of an overlay means.
struct LegendLine {
  Vec4f colour;  ///< linear
  std::string_view text;
  bool (*there)(const Frame&) = nullptr;  ///< whether it can be in the picture; null: always
  /// By what scale it is drawn; null: by none.
  std::string (*scale)(const Frame&, const Overlays&) = nullptr;
};

/// One entry of the list of overlays: name on the command line and in panels, what it shows, and
/// its switch, and what its colours mean (overlay_colours.hpp). One more overlay: a member above,
/// an entry in overlays.cpp, its lines in extract_overlays.cpp.
struct OverlayEntry {
  std::string_view name;
  std::string_view doc;
  bool Overlays::*enabled;
  std::vector<LegendLine> legend;  ///< empty where every colour is only different from the others
};
const std::vector<OverlayEntry>& all_overlays();

/// Kinds of hierarchies that have volumes to show, by name.
const std::vector<std::string>& drawn_hierarchies();

/// Reads "contacts,aabbs,hierarchy:obb:4"; an unknown name is an error that names what there is.
/// After "hierarchy" may stand a kind, a level or both, each after a colon.
Result<Overlays> parse_overlays(std::string_view comma_separated);

}  // namespace tumble
