#pragma once
#include "engine/core/parameters.hpp"

#include <cstdint>

namespace tumble {

/// Settings of the `realtime` stepper. Part of the state of a world.
struct RealtimeSettings {
  int substeps = 4;                    ///< sub-steps per tick of ordinary islands
  int max_substeps = 16;               ///< the same of precise islands, as far as their size allows
  bool precise = false;                ///< all islands are precise, as far as their size allows
  int max_parts = 4;                   ///< of a tick in which thin meshes move fast
  double contact_frequency = 120;      ///< [Hz], at most an eighth of the sub-step rate
  double contact_damping_ratio = 10;   ///< relative to critical damping [-]
  double push_out_speed = 3;           ///< greatest speed at which overlap is corrected [m/s]
  double restitution_threshold = 0.5;  ///< slower impacts do not bounce [m/s]
  double speculative_margin = 0.02;    ///< distance at which contacts are foreseen [m]
  bool continuous = true;
  bool sleeping = true;
  /// Below it a body rests; in multiples of sqrt(gravity * radius) [-]
  double sleep_speed = 0.012;
  double sleep_time = 0.5;  ///< for which an island must rest before it sleeps [s]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.substeps, {.name = "substeps",
                         .min = 1,
                         .max = 256,
                         .doc = "sub-steps per tick of groups of touching bodies"});
    v.field(d.max_substeps, {.name = "max_substeps",
                             .min = 1,
                             .max = 256,
                             .doc = "sub-steps per tick of groups that are solved precisely, as "
                                    "far as their size allows"});
    v.field(d.precise,
            {.name = "precise",
             .doc = "all groups of touching or jointed bodies are solved precisely, in "
                    "max_substeps sub-steps and double precision; else small ones, those "
                    "with couplings or springs, and those of small, thin, weightless, or "
                    "heavy on light bodies"});
    v.field(d.max_parts, {.name = "max_parts",
                          .min = 1,
                          .max = 64,
                          .doc = "how often contacts are found within a tick while thin meshes "
                                 "move past each other fast"});
    v.field(d.contact_frequency, {.name = "contact_frequency",
                                  .unit = "Hz",
                                  .min = 0,
                                  .exclusive_min = true,
                                  .doc = "stiffness of contacts; at most an eighth of the sub-step "
                                         "rate is used"});
    v.field(
        d.contact_damping_ratio,
        {.name = "contact_damping_ratio", .min = 0, .doc = "damping of contacts, 1 is critical"});
    v.field(d.push_out_speed, {.name = "push_out_speed",
                               .unit = "m/s",
                               .min = 0,
                               .doc = "greatest speed at which overlap is worked off"});
    v.field(d.restitution_threshold, {.name = "restitution_threshold",
                                      .unit = "m/s",
                                      .min = 0,
                                      .doc = "slower impacts do not bounce"});
    v.field(d.speculative_margin, {.name = "speculative_margin",
                                   .unit = "m",
                                   .min = 0,
                                   .doc = "distance at which contacts are foreseen"});
    v.field(d.continuous,
            {.name = "continuous", .doc = "swept detection for bodies that move far in a tick"});
    v.field(d.sleeping, {.name = "sleeping", .doc = "bodies at rest are put to sleep"});
    v.field(d.sleep_speed,
            {.name = "sleep_speed",
             .min = 0,
             .doc = "speed below which a body counts as resting, in multiples of "
                    "sqrt(gravity times its radius); in the mean over some ticks, so "
                    "that trembling in place is rest"});
    v.field(d.sleep_time, {.name = "sleep_time",
                           .unit = "s",
                           .min = 0,
                           .doc = "how long a group must rest before it sleeps"});
  }
};

}  // namespace tumble
