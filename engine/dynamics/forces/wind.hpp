#pragma once
#include "engine/dynamics/forces/field.hpp"

#include <array>

namespace tumble {

/// Wind that blows the same way everywhere, with gusts that travel with it: u = U (1 + g s(t -
/// x/U)) with x along the wind and s a sum of three sines whose periods have no common multiple,
/// |s| <= 1.
struct WindDef {
  static constexpr std::string_view type_name = "wind";
  FieldTargets targets;
  VaryingVec3 velocity{5, 0, 0};  ///< U, mean [m/s]
  double gusts = 0;               ///< g [-]
  double gust_period = 4;         ///< of the longest sine [s]
  uint64_t seed = 1;              ///< of the phases of the sines
  FlowGrip grip;

  struct Flow {
    Vec3 velocity, slowness;  ///< slowness: dt/dx of a travelling gust [s/m]
    double gusts, t;
    std::array<double, 3> frequency, phase;  ///< [rad/s], [rad]
    Vec3 operator()(const Vec3& x) const;
  };
  Flow at(double t) const;
  bool varies_in_time() const { return gusts > 0; }

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.velocity, {.name = "velocity", .unit = "m/s", .doc = "mean velocity"});
    v.field(d.gusts, {.name = "gusts",
                      .min = 0,
                      .max = 10,
                      .doc = "greatest change of the speed by gusts, as a share of it"});
    v.field(d.gust_period, {.name = "gust_period",
                            .unit = "s",
                            .min = 0,
                            .exclusive_min = true,
                            .doc = "time between great gusts"});
    v.field(d.seed, {.name = "seed", .doc = "another one: other gusts"});
    FlowGrip::parameters(v, d.grip);
  }
};

}  // namespace tumble
