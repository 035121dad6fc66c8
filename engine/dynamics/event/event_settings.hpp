#pragma once
#include "engine/core/parameters.hpp"

#include <string>

namespace tumble {

/// Settings of the `event` stepper. Part of the state of a world.
struct EventSettings {
  std::string integrator = "rk4";            ///< name in ode::all_integrators()
  std::string impulses = "reflections";      ///< name in all_impact_laws()
  std::string contact_solver = "automatic";  ///< or a name in lcp::all_lcp_solvers()
  std::string friction_cone = "circular";    ///< name in all_friction_cones()
  double tolerance = 1e-9;                   ///< of adaptive integrators, per step [m, rad]
  double recovery_speed = 0.05;              ///< [m/s]
  /// Work that a tick may cost for each body of a group, in units of prices::event [-].
  int budget = 100;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.integrator, {.name = "integrator", .doc = "how motion between events is integrated"});
    v.field(d.impulses, {.name = "impulses", .doc = "law of simultaneous collisions"});
    v.field(d.contact_solver,
            {.name = "contact_solver",
             .doc = "complementarity solver of contact forces that is tried first; automatic: "
                    "what suits the problem, then the others until one finds the forces"});
    v.field(d.friction_cone,
            {.name = "friction_cone", .doc = "circular, or a pyramid for comparison"});
    v.field(d.tolerance, {.name = "tolerance",
                          .unit = "m",
                          .min = 0,
                          .exclusive_min = true,
                          .doc = "error of positions that adaptive integrators may make per step; "
                                 "the same in rad for orientations"});
    v.field(d.recovery_speed, {.name = "recovery_speed",
                               .unit = "m/s",
                               .min = 0,
                               .doc = "how fast overlap is worked off that there was before, and "
                                      "what joints are off by; likewise in rad/s"});
    v.field(d.budget, {.name = "budget",
                       .min = 1,
                       .max = 1000000,
                       .doc = "work that a tick may cost for each body of a group of bodies "
                              "that may meet, in units of a quarter of a millisecond; what costs "
                              "more finishes the tick by time-stepping"});
  }
};

}  // namespace tumble
