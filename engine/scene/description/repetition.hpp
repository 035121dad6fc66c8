#pragma once
#include "engine/scene/description/placement.hpp"

#include <variant>

namespace tumble {

constexpr double max_copies = 200000;  ///< of one body, over all nested repetitions

/// Columns, rows and layers: centred in x and z, rising from the position in y.
struct GridRepetition {
  static constexpr std::string_view type_name = "grid";
  std::array<int, 3> count{1, 1, 1};
  Vec3 spacing{1, 1, 1};  ///< [m]
  Vec3 stagger = Vec3::Zero();
  bool centred = true;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.count, {.name = "count",
                      .min = 1,
                      .max = max_copies,
                      .required = true,
                      .doc = "copies along x, y, z; copy number = (iy nz + iz) nx + ix"});
    v.field(d.spacing, {.name = "spacing",
                        .unit = "m",
                        .min = -1e6,
                        .max = 1e6,
                        .required = true,
                        .doc = "distance from copy to copy"});
    v.field(d.stagger, {.name = "stagger",
                        .unit = "m",
                        .min = -1e6,
                        .max = 1e6,
                        .doc = "shift of every second layer (brick walls)"});
    v.field(d.centred,
            {.name = "centred", .doc = "centred in x and z about the position, else from it"});
  }
};

/// A straight line of copies, each shifted and turned against the one before.
struct StackRepetition {
  static constexpr std::string_view type_name = "stack";
  int count = 1;
  Vec3 step{0, 1, 0};  ///< [m]
  double turn_deg = 0;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.count, {.name = "count",
                      .min = 1,
                      .max = max_copies,
                      .required = true,
                      .doc = "number of copies"});
    v.field(d.step, {.name = "step",
                     .unit = "m",
                     .min = -1e6,
                     .max = 1e6,
                     .required = true,
                     .doc = "from copy to copy"});
    v.field(d.turn_deg, {.name = "turn_deg",
                         .unit = "deg",
                         .min = -1e6,
                         .max = 1e6,
                         .doc = "turn about the vertical from copy to copy"});
  }
};

enum class RingAxis : uint8_t { x, y, z };
template <>
struct EnumNames<RingAxis> {
  static constexpr std::array<std::pair<std::string_view, RingAxis>, 3> values = {
      {{"x", RingAxis::x}, {"y", RingAxis::y}, {"z", RingAxis::z}}};
};

/// Copies on a circle or an arc around the position.
struct RingRepetition {
  static constexpr std::string_view type_name = "ring";
  int count = 1;
  double radius = 1;
  RingAxis axis = RingAxis::y;
  double start_deg = 0;
  double arc_deg = 360;
  bool turn = true;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.count, {.name = "count",
                      .min = 1,
                      .max = max_copies,
                      .required = true,
                      .doc = "number of copies"});
    v.field(
        d.radius,
        {.name = "radius", .unit = "m", .min = 0, .max = 1e6, .required = true, .doc = "radius"});
    v.field(d.axis, {.name = "axis",
                     .doc = "axis of the circle: y from +x towards -z, z from +x towards +y, x "
                            "from +y towards +z"});
    v.field(d.start_deg, {.name = "start_deg",
                          .unit = "deg",
                          .min = -1e6,
                          .max = 1e6,
                          .doc = "angle of the first copy"});
    v.field(d.arc_deg,
            {.name = "arc_deg",
             .unit = "deg",
             .min = -1e6,
             .max = 1e6,
             .doc = "360: evenly all around; else first and last copy stand at the ends"});
    v.field(d.turn, {.name = "turn", .doc = "copies turn with the angle"});
  }
};

enum class ScatterRegion : uint8_t { box, ball, cylinder };
template <>
struct EnumNames<ScatterRegion> {
  static constexpr std::array<std::pair<std::string_view, ScatterRegion>, 3> values = {
      {{"box", ScatterRegion::box},
       {"ball", ScatterRegion::ball},
       {"cylinder", ScatterRegion::cylinder}}};
};

/// Random positions in a box or a ball around the position, from the scene's seed.
struct ScatterRepetition {
  static constexpr std::string_view type_name = "scatter";
  int count = 1;
  ScatterRegion region = ScatterRegion::box;
  Vec3 size{1, 1, 1};  ///< [m]
  double min_distance = 0;
  bool random_orientation = true;
  std::optional<uint64_t> seed;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.count, {.name = "count",
                      .min = 1,
                      .max = max_copies,
                      .required = true,
                      .doc = "number of copies"});
    v.field(d.region, {.name = "region", .doc = "shape of the region"});
    v.field(d.size, {.name = "size",
                     .unit = "m",
                     .min = 0,
                     .max = 1e6,
                     .required = true,
                     .doc = "full extents of the box, or diameters of the ball"});
    v.field(d.min_distance, {.name = "min_distance",
                             .unit = "m",
                             .min = 0,
                             .max = 1e6,
                             .doc = "between positions; fewer copies, with a warning, if full"});
    v.field(d.random_orientation,
            {.name = "random_orientation", .doc = "uniformly random orientations"});
    v.field(d.seed, {.name = "seed", .doc = "instead of one made from the scene's seed"});
  }
};

/// Positions by formulas in `i` (0 .. n-1), `n`, `u` = i / (n-1), and the scene's parameters.
struct FormulaRepetition {
  static constexpr std::string_view type_name = "formula";
  int count = 1;
  std::vector<std::string> position;
  std::vector<std::string> euler_deg;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.count, {.name = "count",
                      .min = 1,
                      .max = max_copies,
                      .required = true,
                      .doc = "number of copies"});
    v.field(d.position, {.name = "position",
                         .unit = "m",
                         .doc = "three expressions, relative to the body's position"});
    v.field(d.euler_deg, {.name = "euler_deg",
                          .unit = "deg",
                          .doc = "three expressions, before the body's own orientation"});
  }
  static void check(const FormulaRepetition& d, Complaints& complaints);
};

/// A list of positions.
struct PointsRepetition {
  static constexpr std::string_view type_name = "points";
  std::vector<Vec3> points;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.points, {.name = "points",
                       .unit = "m",
                       .min = -1e7,
                       .max = 1e7,
                       .required = true,
                       .doc = "relative to the position"});
  }
  static void check(const PointsRepetition& d, Complaints& complaints) {
    if (d.points.empty()) complaints.add("points", "at least one point is needed");
  }
};

using RepetitionKind = std::variant<GridRepetition, StackRepetition, RingRepetition,
                                    ScatterRepetition, FormulaRepetition, PointsRepetition>;

/// Makes copies of a body. Several in a list are nested: each copy of the first carries all of the
/// second.
struct RepetitionDescription {
  RepetitionKind kind;
  Vec3 jitter = Vec3::Zero();  ///< [m]
  double jitter_deg = 0;

  static constexpr std::string_view schema_name = "repetition";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.kind, {.name = "type", .required = true, .doc = "kind of repetition"});
    v.field(d.jitter, {.name = "jitter",
                       .unit = "m",
                       .min = 0,
                       .max = 1e6,
                       .doc = "random shift of each copy, up to this much either way"});
    v.field(d.jitter_deg, {.name = "jitter_deg",
                           .unit = "deg",
                           .min = 0,
                           .max = 180,
                           .doc = "random turn of each copy about a random axis, up to this much"});
  }
};

}  // namespace tumble
