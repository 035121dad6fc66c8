#pragma once
#include "engine/math/ode/step_report.hpp"
#include "engine/math/ode/system.hpp"

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace tumble::ode {

/// Settings; each integrator uses some of them.
struct Settings {
  Tolerance tolerance;            ///< adaptive steps: per step
  double min_step = 1e-12;        ///< adaptive steps: least |h| [s]
  uint32_t max_steps = 1u << 20;  ///< in one advance()
  /// Newton's method stops when a correction is below this; by then it converges at least linearly
  /// with a small factor, so that the remaining error is far smaller.
  Tolerance newton{1e-12, 1e-12, 1e-11};
  uint32_t max_newton_iterations = 50;
};

/// Memory of an adaptive integrator between steps; part of a snapshot.
struct AdaptiveState {
  double h = 0;         ///< the next step to try [s], > 0; 0: none yet
  double error = 1e-4;  ///< of the last step taken, in units of the allowed error [-]
  friend bool operator==(const AdaptiveState&, const AdaptiveState&) = default;
};

/// Relation of a step to the last one.
enum class Start : uint8_t {
  fresh,      ///< unrelated
  continued,  ///< y and the system are as the last step left them: its last derivative is reused
};

/// Advances y' = f(t, y). Owns its scratch memory, so that successive steps of equal size do not
/// allocate; the result depends on t, h, y, the settings and adaptive_state() only, and has the
/// same bits on every machine if f has.
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string_view name() const = 0;
  /// p, where halving h divides the error at a fixed time by 2^p.
  virtual int order() const = 0;
  /// Whether step() may stop short of h.
  virtual bool adaptive() const { return false; }
  /// Whether oscillations and dampers that are much faster than a step are merely damped out, so
  /// that they do not require shorter steps.
  virtual bool bears_stiffness() const { return false; }

  /// One step from t to t + h (backwards for h < 0), or, if adaptive(), part of it: the report's
  /// `advanced` says how far. h = 0 changes nothing. Unless ok, y is unchanged.
  StepReport step(System& system, double t, double h, std::span<double> y,
                  Start start = Start::fresh);

  /// As many steps as are needed to reach t + h. Unless ok, y is unchanged.
  StepReport advance(System& system, double t, double h, std::span<double> y);

  /// The state at a time within the last step, normalised: a polynomial whose error has the
  /// integrator's own order, and which equals the states at both ends of the step bit by bit.
  /// Evaluates no derivative. Extrapolates outside the step. Only after a step that was ok.
  void at(const System& system, double t, std::span<double> y) const;
  double step_begin() const { return t0_; }  ///< of the last step [s]
  double step_end() const { return t0_ + h_; }

  virtual AdaptiveState adaptive_state() const { return {}; }
  virtual void set_adaptive_state(const AdaptiveState&) {}

  Settings settings;

 protected:
  /// Steps from y0_ at t towards t + h: writes y1_ (normalised), returns `advanced`.
  virtual StepReport take(System& system, double t, double h, Start start) = 0;
  /// Interpolates between y0_ and y1_ at theta in [0, 1]; linearly by default.
  virtual void interpolate(double theta, std::span<double> y) const;

  /// Evaluates a derivative, counts and checks it; false sets the status.
  static bool evaluate(System& system, double t, std::span<const double> y, std::span<double> dydt,
                       StepReport& report);
  /// Fills `allowed` for y; false sets the status.
  static bool allow(const System& system, const Tolerance& tolerance, std::span<const double> y,
                    std::span<double> allowed, StepReport& report);

  std::vector<double> y0_, y1_;  ///< the ends of the step
  double t0_ = 0, h_ = 0;        ///< of the last step taken

 private:
  std::vector<double> before_;  ///< the state that a failed advance() returns to
};

struct IntegratorEntry {
  std::string_view name;
  int order;
  std::string_view text;  ///< one-line description
  std::unique_ptr<Integrator> (*make)();
};

/// Every integrator by its standard name.
const std::vector<IntegratorEntry>& all_integrators();

/// Index of the first entry that is not finite; the size if there is none.
size_t first_non_finite(std::span<const double> values);

}  // namespace tumble::ode
