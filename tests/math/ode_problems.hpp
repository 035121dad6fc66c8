#pragma once
// Problems with closed-form solutions for the tests of integrators.
#include "engine/math/ode/integrator.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>

namespace tumble::ode::test {

using State = std::vector<double>;

/// A system with a known solution.
class Problem : public System {
 public:
  virtual State start() const = 0;
  virtual State exact(double t) const = 0;
  size_t size() const override { return start().size(); }
};

/// x'' = -x with the work of the spring: (x, v, W).
class Oscillator : public Problem {
 public:
  State start() const override { return exact(0); }
  State exact(double t) const override {
    const double x = std::cos(t + 0.3), v = -std::sin(t + 0.3), v0 = -std::sin(0.3);
    return {x, v, 0.5 * (v * v - v0 * v0)};
  }
  bool derivative(double, std::span<const double> y, std::span<double> d) override {
    d[0] = y[1];
    d[1] = -y[0];
    d[2] = -y[0] * y[1];
    return true;
  }
  std::span<const EntryKind> kinds() const override {
    static constexpr std::array k{EntryKind::position, EntryKind::momentum, EntryKind::quadrature};
    return k;
  }
};

/// Motion about a fixed centre with unit constants, semi-major axis 1, from the pericentre:
/// (x, y, vx, vy, work of the attraction).
class Kepler : public Problem {
 public:
  explicit Kepler(double eccentricity) : e_(eccentricity) {}
  State start() const override { return exact(0); }
  State exact(double t) const override {
    long double E = t;  // eccentric anomaly
    for (int i = 0; i < 200; ++i) {
      const long double step = (E - e_ * std::sin(E) - t) / (1 - e_ * std::cos(E));
      E -= std::fabs(step) > 0.5L ? std::copysign(0.5L, step) : step;
    }
    const long double b = std::sqrt(1 - (long double)e_ * e_), r = 1 - e_ * std::cos(E);
    const long double work = 1 / r - 1 / (1 - (long double)e_);
    return {double(std::cos(E) - e_), double(b * std::sin(E)), double(-std::sin(E) / r),
            double(b * std::cos(E) / r), double(work)};
  }
  bool derivative(double, std::span<const double> y, std::span<double> d) override {
    const double r2 = y[0] * y[0] + y[1] * y[1], k = 1 / (r2 * std::sqrt(r2));
    d[0] = y[2];
    d[1] = y[3];
    d[2] = -k * y[0];
    d[3] = -k * y[1];
    d[4] = d[2] * y[2] + d[3] * y[3];
    return true;
  }
  std::span<const EntryKind> kinds() const override {
    using enum EntryKind;
    static constexpr std::array k{position, position, momentum, momentum, quadrature};
    return k;
  }

 private:
  double e_;
};

/// A free asymmetric top, moments I1 < I2 < I3: (w, x, y, z of the orientation; angular momentum,
/// world axes). Solution: Jacobi's elliptic functions for the body's angular velocity, a quadrature
/// for the angle about the angular momentum (Landau, Lifshitz, Mechanics, 37).
class FreeTop : public Problem {
 public:
  State start() const override { return exact(0); }
  State exact(double t) const override {
    const auto w = omega(t);
    double phi = 0;
    const int pieces = int(std::ceil(t));
    for (int p = 0; p < pieces; ++p) {
      phi += boost::math::quadrature::gauss<double, 30>::integrate(
          [&](double s) { return precession(omega(s)); }, t * p / pieces, t * (p + 1) / pieces);
    }
    const double l1 = I1 * w[0] / M, l2 = I2 * w[1] / M, l3 = I3 * w[2] / M;
    const double theta = std::acos(l3), psi = std::atan2(l1, l2);
    // Rz(phi) Rx(theta) Rz(psi)
    const double c = std::cos(theta / 2), s = std::sin(theta / 2);
    return {c * std::cos((phi + psi) / 2),
            s * std::cos((phi - psi) / 2),
            s * std::sin((phi - psi) / 2),
            c * std::sin((phi + psi) / 2),
            0,
            0,
            M};
  }
  bool derivative(double, std::span<const double> y, std::span<double> d) override {
    const double n2 = y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3];
    const double w = y[0], a = y[1], b = y[2], c = y[3];
    // Rows of R^T L, divided by the moments: angular velocity in the body.
    const double R[3][3] = {
        {(w * w + a * a - b * b - c * c) / n2, 2 * (a * b - w * c) / n2, 2 * (a * c + w * b) / n2},
        {2 * (a * b + w * c) / n2, (w * w - a * a + b * b - c * c) / n2, 2 * (b * c - w * a) / n2},
        {2 * (a * c - w * b) / n2, 2 * (b * c + w * a) / n2, (w * w - a * a - b * b + c * c) / n2}};
    const double inverse[3] = {1 / I1, 1 / I2, 1 / I3};
    double u[3];
    for (int i = 0; i < 3; ++i) {
      u[i] = inverse[i] * (R[0][i] * y[4] + R[1][i] * y[5] + R[2][i] * y[6]);
    }
    // q' = q (0, u) / 2
    d[0] = 0.5 * (-a * u[0] - b * u[1] - c * u[2]);
    d[1] = 0.5 * (w * u[0] + b * u[2] - c * u[1]);
    d[2] = 0.5 * (w * u[1] + c * u[0] - a * u[2]);
    d[3] = 0.5 * (w * u[2] + a * u[1] - b * u[0]);
    d[4] = d[5] = d[6] = 0;
    return true;
  }
  void normalise(std::span<double> y) const override { normalise_quaternion(y.first<4>()); }
  std::span<const EntryKind> kinds() const override {
    using enum EntryKind;
    static constexpr std::array k{position, position, position, position,
                                  momentum, momentum, momentum};
    return k;
  }

 private:
  static constexpr double I1 = 0.5, I2 = 1, I3 = 1.3, E = 1.2, M = 1.65;
  std::array<double, 3> omega(double t) const {
    const double a = 2 * E * I3 - M * M, b = M * M - 2 * E * I1;
    const double k = std::sqrt((I2 - I1) * a / ((I3 - I2) * b));
    const double rate = std::sqrt((I3 - I2) * b / (I1 * I2 * I3));
    double cn, dn;
    const double sn = boost::math::jacobi_elliptic(k, rate * t, &cn, &dn);
    return {std::sqrt(a / (I1 * (I3 - I1))) * cn, std::sqrt(a / (I2 * (I3 - I2))) * sn,
            std::sqrt(b / (I3 * (I3 - I1))) * dn};
  }
  double precession(const std::array<double, 3>& w) const {
    const double x = w[0] * w[0], y = w[1] * w[1];
    return M * (I1 * x + I2 * y) / (I1 * I1 * x + I2 * I2 * y);
  }
};

/// Largest difference of two states; quaternions in front are compared up to their sign.
inline double difference(const State& a, const State& b, bool quaternion = false) {
  double plus = 0, minus = 0, rest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (quaternion && i < 4) {
      plus = std::max(plus, std::fabs(a[i] - b[i]));
      minus = std::max(minus, std::fabs(a[i] + b[i]));
    } else {
      rest = std::max(rest, std::fabs(a[i] - b[i]));
    }
  }
  return std::max(rest, std::min(plus, minus));
}

/// Fixed steps from t0 on; adaptive integrators are kept from shortening them.
inline State run(Integrator& integrator, Problem& problem, State y, double t0, double h,
                 int steps) {
  if (integrator.adaptive()) {
    integrator.settings.tolerance = {1e20, 1e20, 1e20};
    integrator.set_adaptive_state({std::fabs(h) * 2, 1});
  }
  for (int i = 0; i < steps; ++i) {
    const StepReport r = integrator.step(problem, t0 + i * h, h, y);
    if (!r.ok() || r.advanced != h) return {};
  }
  return y;
}

}  // namespace tumble::ode::test
