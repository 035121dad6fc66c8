#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

/// Ordinary differential equations y' = f(t, y) over a flat state, and integrators for them.
namespace tumble::ode {

/// What an entry of the state is to integrators that treat entries unequally.
enum class EntryKind : uint8_t {
  position,    ///< semi-implicit Euler advances it with the new momenta
  momentum,    ///< advanced first, with the old positions
  quadrature,  ///< the derivative of no entry depends on it (work done so far, ...)
};

/// The error that an adaptive integrator may make per step, and when Newton's method stops.
struct Tolerance {
  double position = 1e-9;     ///< [m], or the unit of whatever is no angle
  double orientation = 1e-9;  ///< [rad]
  double relative = 1e-9;     ///< of the magnitude of the entry [-]
};

/// The right-hand side of y' = f(t, y). Nothing here allocates once the sizes are known.
class System {
 public:
  virtual ~System() = default;

  /// Number of entries of y.
  virtual size_t size() const = 0;

  /// Writes dy/dt. Stages of a step hand in values off the manifold that normalise() returns to,
  /// by O(h^2); f must be smooth there. The same t and y must give the same bits whatever was
  /// asked before. False where there is no derivative (an unsolvable constraint, ...): the step is
  /// refused, and the system keeps the cause.
  [[nodiscard]] virtual bool derivative(double t, std::span<const double> y,
                                        std::span<double> dydt) = 0;

  /// The same for an integrator that reads only entries of kind position and quadrature, for which
  /// forces may be left out of the positions' share; the others may hold anything.
  [[nodiscard]] virtual bool position_derivative(double t, std::span<const double> y,
                                                 std::span<double> dydt) {
    return derivative(t, y, dydt);
  }

  /// Puts y back onto its manifold (unit quaternions): called after every step and on dense
  /// output. A projection moves y by no more than a small multiple of the step's error, and so
  /// keeps the order (Hairer, Lubich, Wanner, Geometric Numerical Integration, IV.4).
  virtual void normalise(std::span<double>) const {}

  /// One kind per entry, or none where the system has no such split; semi-implicit Euler then
  /// refuses it.
  virtual std::span<const EntryKind> kinds() const { return {}; }

  /// Writes df_i/dy_j to `rows`[i * size() + j]; false where the system has none, and finite
  /// differences are taken.
  [[nodiscard]] virtual bool jacobian(double t, std::span<const double> y, std::span<double> rows);

  /// The error allowed in each entry, in the entry's unit, > 0. By default position + relative |y|;
  /// a system that knows its orientations and momenta overrides this.
  virtual void allowed_errors(const Tolerance& tolerance, std::span<const double> y,
                              std::span<double> allowed) const;

  /// How messages name an entry.
  virtual std::string entry_name(size_t entry) const;
};

/// Divides four entries, a quaternion in any order, by their length; leaves zero alone. Unlike a
/// library's, the sum has a fixed order.
void normalise_quaternion(std::span<double, 4> q);

}  // namespace tumble::ode
