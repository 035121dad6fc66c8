#include "engine/dynamics/forces/vortex_ring.hpp"

#include "engine/dynamics/forces/tolerances.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

std::string VortexRingDef::fault() const {
  if (!(axis.norm() > tolerances::no_axis)) return "axis must not be zero";
  if (!(core_radius < 0.5 * radius))
    return "core_radius must be less than half the radius: the ring is thin";
  return {};
}

double VortexRingDef::speed() const {
  return circulation / (4 * det::pi * radius) * (det::log(8 * radius / core_radius) - 0.25);
}

VortexRingDef::Flow VortexRingDef::at(double t) const {
  Flow flow{axis.normalized(), radius, core_radius * core_radius * det::exp(-1.5), {}, 0};
  for (int i = 0; i < count; ++i) {
    const double age = t - start - i * every;
    if (age < 0) break;
    const double left = det::exp(-decay * age);
    // Integral of the speed, by its series where the difference would lose digits.
    const double s = decay * age;
    const double way =
        s < tolerances::exponential_series ? age * (1 - s / 2 * (1 - s / 3)) : (1 - left) / decay;
    flow.rings[size_t(flow.count++)] = {centre + speed() * way * flow.axis,
                                        circulation * left / (2 * det::pi)};
  }
  return flow;
}

Vec3 VortexRingDef::Flow::operator()(const Vec3& x) const {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < count; ++i) sum += of_ring(rings[size_t(i)], x);
  return sum;
}

// With q^2 = z^2 + delta^2, p^2 = (R + r)^2 + q^2 and m = 4 R r / p^2 (Lamb, "Hydrodynamics",
// section 161):
//   along  Gamma / (2 pi p) [K + (R^2 - r^2 - q^2) / ((R - r)^2 + q^2) E]
//   out    Gamma z / (2 pi r p) [-K + (R^2 + r^2 + q^2) / ((R - r)^2 + q^2) E]
Vec3 VortexRingDef::Flow::of_ring(const Ring& ring, const Vec3& x) const {
  const double factor = ring.factor;
  const Vec3 d = x - ring.centre;
  const double z = axis.dot(d);
  const Vec3 radial = d - z * axis;
  const double r2 = radial.squaredNorm(), r = std::sqrt(r2);
  const double q2 = z * z + softening2, big2 = radius * radius;
  const double p2 = (radius + r) * (radius + r) + q2, p = std::sqrt(p2);
  const double near2 = (radius - r) * (radius - r) + q2;
  const EllipticIntegrals f = elliptic_integrals(std::min(4 * radius * r / p2, 1.0));
  const double along = factor / p * (f.k + (big2 - r2 - q2) / near2 * f.e);
  // Over r, which near the axis is the limit: there the difference would lose all digits.
  const double out =
      r > tolerances::near_ring_axis * radius
          ? factor * z / (r2 * p) * (-f.k + (big2 + r2 + q2) / near2 * f.e)
          : 1.5 * det::pi * factor * big2 * z / ((big2 + q2) * (big2 + q2) * std::sqrt(big2 + q2));
  return along * axis + out * radial;
}

EllipticIntegrals elliptic_integrals(double m) {
  double a = 1, b = std::sqrt(1 - m), c = std::sqrt(m), power = 0.5, sum = 0.5 * m;
  // Quadratic convergence: digits double in each round.
  for (int round = 0; round < 12 && c > tolerances::equal_means * a; ++round) {
    c = 0.5 * (a - b);
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
    power *= 2;
    sum += power * c * c;
  }
  const double k = det::pi / (2 * a);
  return {k, k * (1 - sum)};
}

}  // namespace tumble
