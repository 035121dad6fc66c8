#pragma once
#include "engine/scene/description/placement.hpp"
#include "engine/world/sensors/sensor.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

enum class SensorTakes : uint8_t { particles, bodies, both };
template <>
struct EnumNames<SensorTakes> {
  static constexpr std::array<std::pair<std::string_view, SensorTakes>, 3> values = {
      {{"particles", SensorTakes::particles},
       {"bodies", SensorTakes::bodies},
       {"both", SensorTakes::both}}};
};

/// Position of a gate or region, and what it counts.
struct SensorTarget {
  Placement placement;
  std::string body;
  SensorTakes takes = SensorTakes::both;
  std::vector<std::string> bodies, particles;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.part(d.placement);
    v.field(d.body, {.name = "body",
                     .doc = "the body that it is fixed to, in whose frame its place is; with count "
                            "also \"cup[i]\""});
    v.field(d.takes, {.name = "takes", .doc = "what it looks at; of bodies the dynamic ones"});
    v.field(d.bodies, {.name = "bodies",
                       .doc = "only these; a body with copies stands for all of them. With this or "
                              "particles, what neither names is left out"});
    v.field(d.particles, {.name = "particles", .doc = "only those of these systems"});
  }
};

/// Counts what passes through a disc or a rectangle.
struct GateDescription {
  static constexpr std::string_view type_name = "gate";
  std::optional<double> radius;
  std::vector<double> size;
  double span = 1;
  SensorTarget target;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .max = 1e7,
                       .exclusive_min = true,
                       .doc = "of a disc about its y axis, along which is forward"});
    v.field(d.size, {.name = "size",
                     .unit = "m",
                     .min = 0,
                     .max = 1e7,
                     .exclusive_min = true,
                     .doc = "instead: extents of a rectangle along x and z"});
    v.field(d.span, {.name = "span",
                     .unit = "s",
                     .min = 0,
                     .max = 1e6,
                     .exclusive_min = true,
                     .doc = "the flow is the mean over so long"});
    v.part(d.target);
  }
  static void check(const GateDescription& d, Complaints& complaints);
  SensorShape shape() const;
};

/// Counts what is inside a box, sphere or cylinder.
struct RegionDescription {
  static constexpr std::string_view type_name = "region";
  std::vector<double> size;
  std::optional<double> radius, height;
  SensorTarget target;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.size, {.name = "size",
                     .unit = "m",
                     .min = 0,
                     .max = 1e7,
                     .exclusive_min = true,
                     .doc = "extents of a box along x, y and z"});
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .max = 1e7,
                       .exclusive_min = true,
                       .doc = "instead: of a sphere, with height of a cylinder about y"});
    v.field(d.height, {.name = "height",
                       .unit = "m",
                       .min = 0,
                       .max = 1e7,
                       .exclusive_min = true,
                       .doc = "of a cylinder"});
    v.part(d.target);
  }
  static void check(const RegionDescription& d, Complaints& complaints);
  SensorShape shape() const;
};

/// Whether a body touches another one, or any.
struct ContactSensorDescription {
  static constexpr std::string_view type_name = "contact";
  std::string a, b;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.a,
            {.name = "a", .required = true, .doc = "name of a body; with count also \"link[i]\""});
    v.field(d.b, {.name = "b", .doc = "what it touches; any body unless given"});
  }
  static void check(const ContactSensorDescription& d, Complaints& complaints) {
    if (!d.a.empty() && d.a == d.b) complaints.add("b", "a and b are the same body");
  }
};

/// Measures the distribution of distances between particles.
struct RadialDescription {
  static constexpr std::string_view type_name = "radial_distribution";
  std::vector<std::string> particles;
  double range = 1;
  int shells = 60;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.particles,
            {.name = "particles", .required = true, .doc = "of these systems, all together"});
    v.field(d.range, {.name = "range",
                      .unit = "m",
                      .min = 0,
                      .max = 1e7,
                      .exclusive_min = true,
                      .required = true,
                      .doc = "greatest distance; at most half an edge of a periodic box"});
    v.field(d.shells, {.name = "shells",
                       .min = 1,
                       .max = SensorDef::most_shells,
                       .doc = "of equal thickness, up to the range"});
  }
};

/// Something that is measured while a scene runs, without effect on it.
struct SensorDescription {
  std::variant<GateDescription, RegionDescription, ContactSensorDescription, RadialDescription>
      kind;
  int count = 1;
  Vec3 step = Vec3::Zero();

  static constexpr std::string_view schema_name = "sensor";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.kind, {.name = "type", .required = true, .doc = "kind of sensor"});
    v.field(d.count, {.name = "count",
                      .min = 1,
                      .max = 10000,
                      .doc = "so many sensors, named NAME[0], NAME[1], ..."});
    v.field(d.step, {.name = "step",
                     .unit = "m",
                     .min = -1e6,
                     .max = 1e6,
                     .doc = "of the position, from one of them to the next"});
  }
};

}  // namespace tumble
