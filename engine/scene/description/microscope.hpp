#pragma once
#include "engine/scene/description/values.hpp"

#include <optional>
#include <string>

namespace tumble {

/// An algorithm to be shown step by step on two bodies.
struct MicroscopeDescription {
  std::string algorithm = "gjk";
  std::string a, b;
  int step = 0;
  double steps_per_second = 0;
  double span = 1;          ///< [s]
  double tolerance = 1e-3;  ///< [m]
  std::optional<Vec3> beside;
  std::optional<Vec3> velocity_a, velocity_b;                  ///< [m/s]
  std::optional<Vec3> angular_velocity_a, angular_velocity_b;  ///< [rad/s]

  static constexpr std::string_view schema_name = "microscope";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.algorithm,
            {.name = "algorithm", .required = true, .doc = "what is watched, step by step"});
    v.field(d.a, {.name = "a", .doc = "name of a body; of one shape where two are looked at"});
    v.field(d.b, {.name = "b", .doc = "name of another, where two are looked at"});
    v.field(d.step, {.name = "step", .min = 0, .max = 1e6, .doc = "the step shown at first"});
    v.field(d.steps_per_second, {.name = "steps_per_second",
                                 .unit = "1/s",
                                 .min = 0,
                                 .max = 1000,
                                 .doc = "of simulated time; 0: keys only"});
    v.field(d.span, {.name = "span",
                     .unit = "s",
                     .min = 0,
                     .max = 1e6,
                     .exclusive_min = true,
                     .doc = "how far a motion is looked ahead"});
    v.field(d.tolerance, {.name = "tolerance",
                          .unit = "m",
                          .min = 0,
                          .max = 1e6,
                          .exclusive_min = true,
                          .doc = "of a contact"});
    v.field(d.beside, {.name = "beside",
                       .unit = "m",
                       .min = -1e7,
                       .max = 1e7,
                       .doc = "where the difference A - B has its origin; chosen unless given"});
    const auto velocity = [&](auto& value, std::string_view name, std::string_view doc) {
      v.field(value, {.name = name, .unit = "m/s", .min = -1e6, .max = 1e6, .doc = doc});
    };
    velocity(d.velocity_a, "velocity_a", "of a, instead of the body's own");
    velocity(d.velocity_b, "velocity_b", "of b");
    const auto turn = [&](auto& value, std::string_view name, std::string_view doc) {
      v.field(value, {.name = name, .unit = "rad/s", .min = -1e5, .max = 1e5, .doc = doc});
    };
    turn(d.angular_velocity_a, "angular_velocity_a", "of a, instead of the body's own");
    turn(d.angular_velocity_b, "angular_velocity_b", "of b");
  }
};

}  // namespace tumble
