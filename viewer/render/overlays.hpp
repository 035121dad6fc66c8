#pragma once
#include "engine/core/result.hpp"
#include "engine/math/types.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

struct Frame;

/// Which debug overlays are drawn on top of the bodies.
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

  /// Bounding volumes to show: kind of hierarchy ("": that of the world), and levels below its
  /// root.
  std::string hierarchy_kind;
  int hierarchy_level = 3;
  /// Factor on the length of arrows of velocity, momentum and total force [-].
  double vector_length = 1;
};

/// One line of the legend: a colour of an overlay and its meaning.
struct LegendLine {
  Vec4f colour;  ///< linear
  std::string_view text;
  bool (*there)(const Frame&) = nullptr;  ///< whether it can occur in the picture; null: always
  /// Text of the scale at which it is drawn; null: it has none.
  std::string (*scale)(const Frame&, const Overlays&) = nullptr;
};

/// One entry of the list of overlays: its name on the command line and in panels, what it shows,
/// its switch, and what its colours mean (overlay_colours.hpp). To add an overlay: a member above,
/// an entry in overlays.cpp, its lines in extract_overlays.cpp.
struct OverlayEntry {
  std::string_view name;
  std::string_view doc;
  bool Overlays::*enabled;
  std::vector<LegendLine> legend;  ///< empty if the colours only tell things apart
};
const std::vector<OverlayEntry>& all_overlays();

/// Names of the kinds of hierarchies whose volumes can be drawn.
const std::vector<std::string>& drawn_hierarchies();

/// Parses e.g. "contacts,aabbs,hierarchy:obb:4"; the error for an unknown name lists the known
/// ones. After "hierarchy" may follow a kind, a level or both, each after a colon.
Result<Overlays> parse_overlays(std::string_view comma_separated);

}  // namespace tumble
