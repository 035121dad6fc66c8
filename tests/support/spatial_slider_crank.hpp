#pragma once
#include "engine/math/types.hpp"

#include <cmath>
#include <utility>

namespace tumble::test {

/// The spatial slider-crank of Haug (1989, section 12.2) and of the IFToMM library of benchmarks
/// as the one freedom that it is. A crank about x, a rod in a ball joint on it, and a slider along
/// x, to which the rod is tied by a universal joint; z is up, the slider is at no height. It starts
/// with the crank upright at 6 rad/s and falls by itself.
struct SpatialSliderCrankReference {
  static constexpr double crank = .08, rod_length = .3, side = .1, height = .12;      // [m]
  static constexpr double crank_mass = .12, rod_mass = .5, slider_mass = 2;           // [kg]
  static constexpr double crank_inertia = 1e-4, rod_spin = 4e-4, rod_inertia = 4e-3;  // [kg m2]
  static constexpr double start_rate = 6, earth_gravity = 9.81;  // [rad/s], [m/s2]

  /// The end of the crank at its angle, and its rate at 1 rad/s.
  static std::pair<Vec3, Vec3> crank_end(double angle) {
    const double s = std::sin(angle), c = std::cos(angle);
    return {Vec3(0, side - crank * s, height + crank * c), Vec3(0, -crank * c, -crank * s)};
  }
  static double slider_at(double angle) {
    return std::sqrt(rod_length * rod_length - crank_end(angle).first.squaredNorm());
  }
  /// Of all bodies at a crank's angle: twice the kinetic energy at 1 rad/s, and the sum of masses
  /// times heights.
  static std::pair<double, double> inertia_and_moment(double angle) {
    const auto [B, of_b] = crank_end(angle);
    const double x = slider_at(angle), rate = -B.dot(of_b) / x;
    const Vec3 C(x, 0, 0), of_c(rate, 0, 0), r = C - B, turning = of_c - of_b;
    // It turns across itself as its ends say, and about itself so that what is across x and it
    // stays across x.
    const Vec3 swing = r.cross(turning) / r.squaredNorm(), across = Vec3::UnitX().cross(r);
    const double spin =
        -Vec3::UnitX().dot(swing.cross(across)) / Vec3::UnitX().dot(r.normalized().cross(across));
    const double inertia = crank_inertia + crank_mass * crank * crank / 4 +
                           rod_mass * (0.5 * (of_b + of_c)).squaredNorm() +
                           rod_inertia * swing.squaredNorm() + rod_spin * spin * spin +
                           slider_mass * rate * rate;
    return {inertia, crank_mass * (height + crank * std::cos(angle) / 2) + rod_mass * B.z() / 2};
  }
  static double start_energy() {
    const auto [inertia, moment] = inertia_and_moment(0);
    return 0.5 * inertia * start_rate * start_rate + earth_gravity * moment;
  }
  /// The time to a crank's angle by its energy, by Simpson's rule.
  static double time_to(double angle) {
    const auto slowness = [whole = start_energy()](double a) {
      const auto [inertia, moment] = inertia_and_moment(a);
      return std::sqrt(0.5 * inertia / (whole - earth_gravity * moment));
    };
    constexpr int parts = 4000;
    double sum = slowness(0) + slowness(angle);
    for (int i = 1; i < parts; ++i) sum += (i % 2 ? 4 : 2) * slowness(angle * i / parts);
    return sum * angle / (3 * parts);
  }
};

}  // namespace tumble::test
