#pragma once
#include "engine/core/parameters.hpp"
#include "engine/dynamics/forces/force_context.hpp"
#include "engine/math/varying.hpp"

#include <string_view>

namespace tumble {

/// Damped spring between two anchors: F = -(k (l - l0) + c dl/dt) along the line. Over a tick all
/// springs that hang together are taken at once by pull_springs(), and apply() takes one as if it
/// were alone; what a tick does not resolve of a spring loses energy to the step (SpringNet).
struct SpringDef {
  static constexpr std::string_view type_name = "spring";
  Anchor a, b;
  Varying stiffness = 100;  ///< [N/m]
  Varying damping = 1;      ///< [N s/m]
  Varying rest_length = 1;  ///< [m]
  double cable_radius = 0;  ///< drawn as a straight cable this thick, 0: as a coil [m]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.stiffness, {.name = "stiffness", .unit = "N/m", .min = 0, .doc = "spring constant"});
    v.field(d.damping, {.name = "damping", .unit = "N s/m", .min = 0, .doc = "damping constant"});
    v.field(d.rest_length, {.name = "rest_length", .unit = "m", .min = 0, .doc = "length at rest"});
    v.field(d.cable_radius, {.name = "cable_radius",
                             .unit = "m",
                             .min = 0,
                             .doc = "drawn as a straight cable this thick; 0: as a coil"});
  }
};

void apply(const SpringDef& def, ForceContext& context);
double potential_energy(const SpringDef& def, const ForceContext& context);

}  // namespace tumble
