#pragma once
#include "engine/dynamics/forces/force_context.hpp"
#include "engine/math/varying.hpp"

#include <string>
#include <string_view>

namespace tumble {

/// A force at a point of a body or on a particle, and a torque on the body. In the body's axes it
/// is a thrust, which turns with it. Its work comes from outside.
struct LoadDef {
  static constexpr std::string_view type_name = "load";
  Anchor anchor;
  VaryingVec3 force;       ///< [N]
  VaryingVec3 torque;      ///< [N m]
  bool body_axes = false;  ///< whether force and torque are along the body's axes

  /// Empty, or why it cannot act as it is.
  std::string fault() const;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.force, {.name = "force", .unit = "N", .doc = "at the anchor"});
    v.field(d.torque, {.name = "torque", .unit = "N m", .doc = "on the body of the anchor"});
    v.field(d.body_axes, {.name = "body_axes",
                          .doc = "along the axes of the body, and turns with it; else those of "
                                 "the world"});
  }
};

void apply(const LoadDef& def, ForceContext& context);

}  // namespace tumble
