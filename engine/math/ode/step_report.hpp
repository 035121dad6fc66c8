#pragma once
#include "engine/core/error.hpp"
#include "engine/math/ode/system.hpp"

#include <string_view>

namespace tumble::ode {

enum class StepStatus : uint8_t {
  ok,
  bad_input,       ///< a step or time that is not finite, a state of another size
  bad_tolerance,   ///< the error allowed in an entry is not > 0
  bad_state,       ///< the state at the start is not finite
  non_finite,      ///< a derivative or the new state is not finite
  refused,         ///< the system could not give a derivative
  not_converged,   ///< Newton's method found no solution of the implicit step
  step_too_small,  ///< the required error needs a step below the least allowed
  too_many_steps,  ///< more steps than allowed
  no_split,        ///< the integrator needs positions and momenta, the system names none
};

std::string_view to_string(StepStatus status);

/// Report of a step, or of a sequence of steps. Unless ok, the state is as before.
struct StepReport {
  StepStatus status = StepStatus::ok;
  uint32_t evaluations = 0;        ///< of the derivative
  uint32_t steps = 0;              ///< taken
  uint32_t rejected = 0;           ///< steps tried, and repeated with a smaller h
  uint32_t newton_iterations = 0;  ///< of implicit steps
  double advanced = 0;             ///< by how much t grew [s]; exactly h when all of h was done
  /// Estimated error over allowed error, the greatest of all entries and steps; at most 1 when
  /// ok. 0 from integrators that have no estimate.
  double error = 0;
  size_t component = 0;  ///< the entry that is not finite, or farthest from converged
  double t = 0;          ///< time of the evaluation that failed, else the end of the step [s]

  bool ok() const { return status == StepStatus::ok; }
  /// Adds the report of a following step.
  void include(const StepReport& next);
  /// For a report that is not ok: the error, with the system's name of the entry, and a cure.
  Error text(std::string_view integrator, const System& system) const;
};

}  // namespace tumble::ode
