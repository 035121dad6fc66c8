#pragma once
#include "engine/scene/description/anchor.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Which nodes of a sheet are fixed. Row 0 is the top, column 0 the left.
enum class PinPlace : uint8_t {
  node,
  top,
  bottom,
  left,
  right,
  corners,
  top_left,
  top_right,
  bottom_left,
  bottom_right
};
template <>
struct EnumNames<PinPlace> {
  static constexpr std::array<std::pair<std::string_view, PinPlace>, 10> values = {
      {{"node", PinPlace::node},
       {"top", PinPlace::top},
       {"bottom", PinPlace::bottom},
       {"left", PinPlace::left},
       {"right", PinPlace::right},
       {"corners", PinPlace::corners},
       {"top_left", PinPlace::top_left},
       {"top_right", PinPlace::top_right},
       {"bottom_left", PinPlace::bottom_left},
       {"bottom_right", PinPlace::bottom_right}}};
};

/// Nodes of a sheet that are fixed in the world, or on a body.
struct PinDescription {
  PinPlace at = PinPlace::node;
  int row = 0, column = 0;
  int every = 1;
  std::string body;

  static constexpr std::string_view schema_name = "pin";
  static constexpr std::string_view shorthand_key = "at";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.at, {.name = "at", .doc = "a side, a corner, all corners, or one node"});
    v.field(d.row, {.name = "row", .min = 0, .max = 1e4, .doc = "of a node, from the top"});
    v.field(d.column, {.name = "column", .min = 0, .max = 1e4, .doc = "of a node, from the left"});
    v.field(d.every,
            {.name = "every", .min = 1, .max = 1e4, .doc = "of a side: one node in so many"});
    v.field(d.body, {.name = "body", .doc = "held by this body, else by the world"});
  }
};

/// Parameters of the springs, common to all weaves (cloths, nets, ropes).
struct WeaveSpringsDescription {
  double damping_ratio = 0.1;
  double break_strain = 0;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.damping_ratio, {.name = "damping_ratio",
                              .min = 0,
                              .max = 100,
                              .doc = "of each spring between two masses of a node"});
    v.field(d.break_strain, {.name = "break_strain",
                             .min = 0,
                             .max = 1e6,
                             .doc = "springs stretched by this share break; 0: none do"});
  }
};

/// What cloths and nets have in common: a rectangle of nodes that are particles.
struct SheetDescription {
  Vec3 corner = Vec3::Zero();           ///< [m]
  Vec3 across{1, 0, 0}, down{0, 0, 1};  ///< [m]
  int columns = 20, rows = 20;
  WeaveSpringsDescription springs;
  double radius = 0;  ///< [m]
  std::vector<PinDescription> pins;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.corner, {.name = "corner",
                       .unit = "m",
                       .min = -1e7,
                       .max = 1e7,
                       .required = true,
                       .doc = "its top left node"});
    v.field(d.across, {.name = "across",
                       .unit = "m",
                       .min = -1e6,
                       .max = 1e6,
                       .required = true,
                       .doc = "from the left side to the right one"});
    v.field(d.down, {.name = "down",
                     .unit = "m",
                     .min = -1e6,
                     .max = 1e6,
                     .required = true,
                     .doc = "from the top to the bottom, at right angles to across"});
    v.field(d.columns,
            {.name = "columns", .min = 2, .max = 1000, .required = true, .doc = "of nodes"});
    v.field(d.rows, {.name = "rows", .min = 2, .max = 1000, .required = true, .doc = "of nodes"});
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .max = 1e3,
                       .doc = "of its particles, half the thickness with which it collides; 0: two "
                              "fifths of the spacing"});
    v.part(d.springs);
    v.list(d.pins, {.name = "pins", .doc = "nodes that are held where they start"});
  }
};

struct ClothDescription {
  SheetDescription sheet;
  double density = 0.2;                        ///< [kg/m2]
  double stretch = 300, shear = 60, bend = 0;  ///< [N/m], [N/m], [N m]
  std::optional<Colour> second_colour;
  int stripe = 0;

  static constexpr std::string_view schema_name = "cloth";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.part(d.sheet);
    v.field(d.density, {.name = "density",
                        .unit = "kg/m2",
                        .min = 0,
                        .max = 1e6,
                        .exclusive_min = true,
                        .doc = "mass by area"});
    v.field(d.stretch, {.name = "stretch",
                        .unit = "N/m",
                        .min = 0,
                        .max = 1e12,
                        .exclusive_min = true,
                        .doc = "Young's modulus times thickness, of a strip along the threads"});
    v.field(d.shear, {.name = "shear",
                      .unit = "N/m",
                      .min = 0,
                      .max = 1e12,
                      .doc = "shear modulus times thickness"});
    v.field(d.bend, {.name = "bend",
                     .unit = "N m",
                     .min = 0,
                     .max = 1e12,
                     .doc = "flexural rigidity: moment by width over curvature"});
    v.field(d.second_colour, {.name = "second_colour",
                              .doc = "of every other stripe; the system's colour for the rest"});
    v.field(d.stripe,
            {.name = "stripe", .min = 0, .max = 1e4, .doc = "width of a stripe in cells; 0: none"});
  }
};

struct NetDescription {
  SheetDescription sheet;
  double density = 0.02;         ///< [kg/m]
  double stiffness = 500;        ///< [N]
  double thread_radius = 0.004;  ///< [m]

  static constexpr std::string_view schema_name = "net";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.part(d.sheet);
    v.field(d.density, {.name = "density",
                        .unit = "kg/m",
                        .min = 0,
                        .max = 1e6,
                        .exclusive_min = true,
                        .doc = "of a thread, mass by length"});
    v.field(d.stiffness, {.name = "stiffness",
                          .unit = "N",
                          .min = 0,
                          .max = 1e12,
                          .exclusive_min = true,
                          .doc = "of a thread: tension over strain"});
    v.field(d.thread_radius,
            {.name = "thread_radius", .unit = "m", .min = 0, .max = 1e3, .doc = "as drawn"});
  }
};

/// A point on a rope's path; a body with copies stands for all of them in their order.
struct RopePlaceDescription {
  AnchorDescription anchor;
  bool loose = false;

  static constexpr std::string_view schema_name = "rope_place";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.part(d.anchor);
    v.field(d.loose, {.name = "loose", .doc = "an end that nothing holds"});
  }
  static void check(const RopePlaceDescription& d, Complaints& complaints) {
    AnchorDescription::check(d.anchor, complaints);
    if (d.loose && (!d.anchor.body.empty() || !d.anchor.particles.empty()))
      complaints.add("loose", "a loose end is a point of the world where it starts");
  }
};

struct RopeDescription {
  std::vector<RopePlaceDescription> path;
  int segments = 20;
  double slack = 1;
  double density = 0.1;              ///< [kg/m]
  double stiffness = 1e4, bend = 0;  ///< [N], [N m2]
  WeaveSpringsDescription springs;
  double radius = 0.01;  ///< [m]

  static constexpr std::string_view schema_name = "rope";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.list(d.path,
           {.name = "path", .required = true, .doc = "two places and more that it goes through"});
    v.field(d.segments,
            {.name = "segments", .min = 1, .max = 1e4, .doc = "between each two places"});
    v.field(d.slack, {.name = "slack",
                      .min = 1,
                      .max = 100,
                      .doc = "length between two places over their distance: it hangs down"});
    v.field(d.density, {.name = "density",
                        .unit = "kg/m",
                        .min = 0,
                        .max = 1e6,
                        .exclusive_min = true,
                        .doc = "mass by length"});
    v.field(d.stiffness, {.name = "stiffness",
                          .unit = "N",
                          .min = 0,
                          .max = 1e12,
                          .exclusive_min = true,
                          .doc = "tension over strain"});
    v.field(d.bend, {.name = "bend",
                     .unit = "N m2",
                     .min = 0,
                     .max = 1e12,
                     .doc = "flexural rigidity: moment over curvature"});
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .max = 1e3,
                       .exclusive_min = true,
                       .doc = "half its thickness"});
    v.part(d.springs);
  }
  static void check(const RopeDescription& d, Complaints& complaints) {
    if (d.path.empty()) complaints.add("path", "needs two places and more");
  }
};

}  // namespace tumble
