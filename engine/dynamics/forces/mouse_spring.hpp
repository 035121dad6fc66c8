#pragma once
#include "engine/core/parameters.hpp"
#include "engine/dynamics/forces/force_context.hpp"

#include <string_view>

namespace tumble {

/// Pulls a point of a body (or a particle) to a target in the world: frequency and damping ratio
/// times the effective mass at the point, so that it feels the same on 1 g and on 10 t. The
/// frequency is bounded by 0.4/h, the force by `max_weights` times the weight, and torsional
/// damping of the same ratio keeps the body from spinning up.
struct MouseSpringDef {
  static constexpr std::string_view type_name = "mouse_spring";
  Anchor anchor;
  Vec3 target = Vec3::Zero();  ///< [m]
  double frequency = 4;        ///< [Hz]
  double damping_ratio = 1;    ///< [-]
  double max_weights = 50;     ///< [-]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.target, {.name = "target", .unit = "m", .doc = "point that it pulls to"});
    v.field(d.frequency, {.name = "frequency",
                          .unit = "Hz",
                          .min = 0,
                          .exclusive_min = true,
                          .doc = "undamped frequency"});
    v.field(d.damping_ratio, {.name = "damping_ratio", .min = 0, .doc = "1 is critical"});
    v.field(d.max_weights, {.name = "max_weights",
                            .min = 0,
                            .exclusive_min = true,
                            .doc = "cap of the force in multiples of the weight"});
  }
};

void apply(const MouseSpringDef& def, ForceContext& context);

}  // namespace tumble
