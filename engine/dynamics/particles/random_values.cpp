#include "engine/dynamics/particles/random_values.hpp"

#include "engine/dynamics/particles/tolerances.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

using tolerances::normal_reach;

namespace {

uint64_t scrambled(uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

double RandomNumber::reach() const {
  return kind == Kind::normal ? normal_reach * spread : spread;
}

double RandomNumber::draw(Random& random) const {
  if (spread == 0) return mean;
  if (kind == Kind::normal) return mean + spread * standard_normal(random);
  return random.uniform(mean - spread, mean + spread);
}

Random numbered_random(uint64_t seed, uint64_t n) {
  constexpr uint64_t step = 0x9e3779b97f4a7c15ULL;  // 2^64 over the golden ratio
  const uint64_t first = scrambled(seed + (2 * n + 1) * step);
  return Random(first, scrambled(first + step));
}

double standard_normal(Random& random) {
  for (;;) {
    const double radius = std::sqrt(-2 * det::log(1 - random.uniform()));
    const double z = radius * det::cos(2 * det::pi * random.uniform());
    if (std::fabs(z) <= normal_reach) return z;
  }
}

Vec3 direction_in_cone(Random& random, const Vec3& axis, double cosine) {
  if (cosine >= 1) return axis;
  const double along = 1 - random.uniform() * (1 - cosine);  // uniform along the axis (Archimedes)
  const double across = std::sqrt(std::max(0.0, 1 - along * along));
  const double turn = 2 * det::pi * random.uniform();
  Vec3 t1, t2;
  tangent_frame(axis, t1, t2);
  return along * axis + across * (det::cos(turn) * t1 + det::sin(turn) * t2);
}

Vec3 random_unit_vector(Random& random) {
  return direction_in_cone(random, Vec3::UnitY(), -1);
}

Quat random_orientation(Random& random) {
  const double u = random.uniform();
  const double a = 2 * det::pi * random.uniform(), b = 2 * det::pi * random.uniform();
  const double p = std::sqrt(1 - u), q = std::sqrt(u);
  return {q * det::cos(b), p * det::sin(a), p * det::cos(a), q * det::sin(b)};
}

}  // namespace tumble
