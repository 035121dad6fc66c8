#include "engine/math/ode/step_report.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble::ode {

std::string_view to_string(StepStatus status) {
  switch (status) {
    case StepStatus::ok:
      return "ok";
    case StepStatus::bad_input:
      return "bad_input";
    case StepStatus::bad_tolerance:
      return "bad_tolerance";
    case StepStatus::bad_state:
      return "bad_state";
    case StepStatus::non_finite:
      return "non_finite";
    case StepStatus::refused:
      return "refused";
    case StepStatus::not_converged:
      return "not_converged";
    case StepStatus::step_too_small:
      return "step_too_small";
    case StepStatus::too_many_steps:
      return "too_many_steps";
    case StepStatus::no_split:
      return "no_split";
  }
  return "unknown";
}

void StepReport::include(const StepReport& next) {
  status = next.status;
  evaluations += next.evaluations;
  steps += next.steps;
  rejected += next.rejected;
  newton_iterations += next.newton_iterations;
  advanced += next.advanced;
  error = std::max(error, next.error);
  component = next.component;
  t = next.t;
}

Error StepReport::text(std::string_view integrator, const System& system) const {
  const std::string entry = component < system.size() ? system.entry_name(component) : "";
  Error e{ErrorCode::numeric, {}, std::string(integrator), {}};
  switch (status) {
    case StepStatus::ok:
      e.message = "the step was taken";
      break;
    case StepStatus::bad_input:
      e.code = ErrorCode::invalid_argument;
      e.message = fmt::format(
          "time and step must be finite and the state must have {} entries, as the system says",
          system.size());
      break;
    case StepStatus::bad_tolerance:
      e.code = ErrorCode::invalid_argument;
      e.message = fmt::format("the error allowed in {} must be > 0", entry);
      e.cure = "ask for tolerances > 0";
      break;
    case StepStatus::bad_state:
      e.message = fmt::format("{} is not finite at the start of the step, t = {} s", entry, t);
      break;
    case StepStatus::non_finite:
      e.message = fmt::format("{} or its derivative is not finite at t = {} s", entry, t);
      e.cure = "take smaller steps, or look for a force that has no value there";
      break;
    case StepStatus::refused:
      e.message = fmt::format("the forces have no solution at t = {} s", t);
      break;
    case StepStatus::not_converged:
      e.message = fmt::format(
          "the implicit step to t = {} s was not solved in {} iterations, {} is "
          "farthest from it",
          t, newton_iterations, entry);
      e.cure = "take smaller steps, or allow more iterations";
      break;
    case StepStatus::step_too_small:
      e.message = fmt::format(
          "the asked error needs steps below the least allowed at t = {} s, because of {}", t,
          entry);
      e.cure = "allow a greater error or a smaller step, or look for a force that jumps there";
      break;
    case StepStatus::too_many_steps:
      e.message = fmt::format("{} steps did not suffice, they reached t = {} s", steps, t);
      e.cure = "allow a greater error or more steps";
      break;
    case StepStatus::no_split:
      e.code = ErrorCode::unsupported;
      e.message = "the system does not say which entries are positions and which are momenta";
      e.cure = "choose another integrator";
      break;
  }
  return e;
}

}  // namespace tumble::ode
