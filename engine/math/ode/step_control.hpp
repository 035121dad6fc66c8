#pragma once

namespace tumble::ode {

/// The next step from the error of the last one (Gustafsson 1991, "Control theoretic techniques for
/// stepsize selection in explicit Runge-Kutta methods"; Hairer, Norsett, Wanner I, II.4, with
/// their constants for a method of order 5(4)). Errors are in units of the allowed error.
struct StepControl {
  static constexpr double safety = 0.9, beta = 0.04, exponent = 0.2 - 0.75 * beta;
  static constexpr double least = 0.2, most = 10;  ///< factors by which a step may change

  /// Factor for the step after one with error <= 1, which followed one with `before`.
  static double after_accepted(double error, double before);
  /// Factor for the repetition of a step with error > 1.
  static double after_rejected(double error);
};

}  // namespace tumble::ode
