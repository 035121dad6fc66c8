#include "engine/math/ode/step_control.hpp"

#include "engine/math/det/det.hpp"

#include <algorithm>

namespace tumble::ode {

double StepControl::after_accepted(double error, double before) {
  if (!(error > 0)) return most;
  // Below this, as in a state that was never set, the last error says nothing.
  before = before > 1e-4 ? before : 1e-4;
  const double factor = safety * det::pow(before, beta) / det::pow(error, exponent);
  return std::clamp(factor, least, most);
}

double StepControl::after_rejected(double error) {
  return std::clamp(safety / det::pow(error, exponent), least, 1.0);
}

}  // namespace tumble::ode
