#pragma once
#include "engine/dynamics/forces/field.hpp"

namespace tumble {

/// The same acceleration everywhere: gravity for some, or what things feel in a box that is shaken.
/// Potential -a x.
struct UniformFieldDef {
  static constexpr std::string_view type_name = "uniform_field";
  FieldTargets targets;
  VaryingVec3 a{0, -9.81, 0};  ///< [m/s2]

  Vec3 acceleration(const Vec3&) const { return a.now(); }
  double potential(const Vec3& x) const { return -a.now().dot(x); }

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.a, {.name = "acceleration",
                  .unit = "m/s2",
                  .doc = "the same everywhere, in addition to gravity"});
  }
};

}  // namespace tumble
