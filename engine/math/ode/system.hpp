#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

/// Ordinary differential equations y' = f(t, y) over a flat state, and integrators for them.
namespace tumble::ode {

/// Kind of an entry of the state, for integrators that treat entries differently.
enum class EntryKind : uint8_t {
  position,    ///< semi-implicit Euler advances it with the new momenta
  momentum,    ///< advanced first, with the old positions
  quadrature,  ///< no derivative depends on it (work done so far, ...)
};

/// The error that an adaptive integrator may make per step, and the limit at which Newton's method
/// stops.
struct Tolerance {
  double position = 1e-9;     ///< [m], or the unit of whatever is no angle
  double orientation = 1e-9;  ///< [rad]
  double relative = 1e-9;     ///< of the magnitude of the entry [-]
};

/// The right-hand side of y' = f(t, y). Its functions do not allocate once the sizes are known.
class System {
 public:
  virtual ~System() = default;

  /// Number of entries of y.
  virtual size_t size() const = 0;

  /// Writes dy/dt. Stages of a step evaluate it at states that are off the manifold of normalise()
  /// by O(h^2), where f must be smooth. The same t and y must give the same bits, independent of
  /// earlier calls. Returns false if there is no derivative (an unsolvable constraint, ...): the
  /// step is then refused, and the system stores the cause.
  [[nodiscard]] virtual bool derivative(double t, std::span<const double> y,
                                        std::span<double> dydt) = 0;

  /// The same for an integrator that uses only entries of kind position and quadrature, so that
  /// forces may be omitted for the positions; other entries are arbitrary.
  [[nodiscard]] virtual bool position_derivative(double t, std::span<const double> y,
                                                 std::span<double> dydt) {
    return derivative(t, y, dydt);
  }

  /// Projects y onto its manifold (unit quaternions): called after every step and for dense output.
  /// A projection changes y by no more than a small multiple of the step's error, and so preserves
  /// the order (Hairer, Lubich, Wanner, Geometric Numerical Integration, IV.4).
  virtual void normalise(std::span<double>) const {}

  /// One kind per entry, or empty if the system has no such split; semi-implicit Euler then refuses
  /// it.
  virtual std::span<const EntryKind> kinds() const { return {}; }

  /// Writes df_i/dy_j to `rows`[i * size() + j]; false if the system has none, and finite
  /// differences are used.
  [[nodiscard]] virtual bool jacobian(double t, std::span<const double> y, std::span<double> rows);

  /// The error allowed in each entry, in the entry's unit, > 0. By default position + relative |y|;
  /// a system that knows its orientations and momenta overrides this.
  virtual void allowed_errors(const Tolerance& tolerance, std::span<const double> y,
                              std::span<double> allowed) const;

  /// Name of an entry in messages.
  virtual std::string entry_name(size_t entry) const;
};

/// Normalises four entries, a quaternion in any order; zero is unchanged. The sum is in a fixed
/// order, unlike in a library.
void normalise_quaternion(std::span<double, 4> q);

}  // namespace tumble::ode
