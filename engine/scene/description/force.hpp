#pragma once
#include "engine/dynamics/forces/force.hpp"
#include "engine/scene/description/values.hpp"

#include <variant>

namespace tumble {

/// Where a force takes hold: a point of a body (in its own frame), a particle, or of the world.
struct AnchorDescription {
  std::string body;
  std::string particles;
  int index = 0;
  Vec3 point = Vec3::Zero();  ///< [m]

  static constexpr std::string_view schema_name = "anchor";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.body, {.name = "body", .doc = "name of a body, or of a copy: \"brick[3]\""});
    v.field(d.particles, {.name = "particles", .doc = "instead: name of a particle system"});
    v.field(d.index, {.name = "index", .min = 0, .max = 1e7, .doc = "number of the particle"});
    v.field(d.point, {.name = "point",
                      .unit = "m",
                      .min = -1e7,
                      .max = 1e7,
                      .doc = "in the body's frame; without body or particles in the world"});
  }
  static void check(const AnchorDescription& d, Complaints& complaints) {
    if (!d.body.empty() && !d.particles.empty())
      complaints.add("", "give body or particles, not both");
  }
};

struct SpringDescription {
  static constexpr std::string_view type_name = SpringDef::type_name;
  AnchorDescription a, b;
  double stiffness = 100, damping = 1;
  std::optional<double> rest_length;
  double cable_radius = 0;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.object(d.a, {.name = "a", .required = true, .doc = "one end"});
    v.object(d.b, {.name = "b", .required = true, .doc = "other end"});
    v.field(d.stiffness,
            {.name = "stiffness", .unit = "N/m", .min = 0, .max = 1e12, .doc = "spring constant"});
    v.field(d.damping,
            {.name = "damping", .unit = "N s/m", .min = 0, .max = 1e12, .doc = "damping constant"});
    v.field(d.rest_length, {.name = "rest_length",
                            .unit = "m",
                            .min = 0,
                            .max = 1e6,
                            .doc = "length at rest; the initial distance unless given"});
    v.field(d.cable_radius, {.name = "cable_radius",
                             .unit = "m",
                             .min = 0,
                             .max = 1e3,
                             .doc = "drawn as a straight cable this thick; 0: as a coil"});
  }
};

/// Pulls a point of a body to a place, as the mouse does.
struct MouseSpringDescription {
  static constexpr std::string_view type_name = MouseSpringDef::type_name;
  AnchorDescription anchor;
  MouseSpringDef spring;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.object(d.anchor, {.name = "anchor", .required = true, .doc = "what is pulled"});
    v.part(d.spring);
  }
};

using ForceKind =
    std::variant<LinearDragDef, QuadraticDragDef, SpringDescription, MouseSpringDescription>;

struct ForceDescription {
  ForceKind kind;

  static constexpr std::string_view schema_name = "force";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.kind, {.name = "type", .required = true, .doc = "kind of force"});
  }
};

}  // namespace tumble
