#include "engine/dynamics/forces/turbulence.hpp"

#include "engine/core/work_meter.hpp"
#include "engine/dynamics/forces/tolerances.hpp"
#include "engine/math/det/det.hpp"

#include <cmath>
#include <vector>

namespace tumble {
namespace {

uint64_t mixed(uint64_t z) {  // splitmix64 (Steele, Lea, Flood 2014)
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Numbers of a point of the lattice, 16 bits each.
class LatticeNumbers {
 public:
  LatticeNumbers(const std::array<int64_t, 3>& cell, uint64_t seed)
      : state_(mixed(mixed(mixed(seed + uint64_t(cell[0])) + uint64_t(cell[1])) +
                     uint64_t(cell[2]))) {}
  uint64_t bits() {
    if (left_ == 0) {
      word_ = mixed(state_ += 0x9e3779b97f4a7c15ULL);
      left_ = 4;
    }
    --left_;
    const uint64_t out = word_ & 0xffff;
    word_ >>= 16;
    return out;
  }
  /// Uniform in (-1, 1).
  double number() { return (double(bits()) - 32767.5) / 32768; }

 private:
  uint64_t state_, word_ = 0;
  int left_ = 0;
};

/// What the gradients of a point of the lattice are made of: cosine[phase] first + sine[phase]
/// second.
struct LatticePoint {
  std::array<int64_t, 3> cell{};
  uint64_t seed = 0;
  bool known = false;
  size_t phase = 0;
  Mat3 first, second;
};

/// The point, from a table of those that this thread asked for last: drawing the numbers takes
/// longer than all the rest, and a body asks for the same points again and again.
const LatticePoint& lattice_point(const std::array<int64_t, 3>& cell, uint64_t seed) {
  constexpr size_t count = 512;  // 8 octaves of 8 corners for 8 bodies [-]
  thread_local std::vector<LatticePoint> table(count);
  const auto folded = uint64_t(cell[0]) * 0x9e3779b97f4a7c15ULL +
                      uint64_t(cell[1]) * 0x85157af5ULL + uint64_t(cell[2]) * 0xc2b2ae35ULL + seed;
  LatticePoint& p = table[(folded ^ (folded >> 32)) % count];
  if (p.known && p.cell == cell && p.seed == seed) return p;
  LatticeNumbers numbers(cell, seed);
  p.known = true;
  p.cell = cell;
  p.seed = seed;
  p.phase = numbers.bits() % TurbulenceDef::phases;
  for (int i = 0; i < 9; ++i) {
    p.first(i / 3, i % 3) = numbers.number();
    p.second(i / 3, i % 3) = numbers.number();
  }
  return p;
}

/// 1 at 0, 0 at 1, with two derivatives that vanish at both ends (Perlin 2002).
double fade(double t) {
  return 1 - t * t * t * (10 + t * (6 * t - 15));
}
double fade_rate(double t) {
  return -30 * t * t * (1 + t * (t - 2));
}

/// Curl of psi = sum over the corners of w(d) G d, with d from the corner, w the product of the
/// fades and G the corner's gradients: grad w x (G d) + w (curl of G d).
Vec3 curl_noise(const Vec3& p, uint64_t seed, const TurbulenceDef::Flow& flow) {
  charge_work(1000);
  Vec3 sum = Vec3::Zero();
  const Vec3 base(std::floor(p.x()), std::floor(p.y()), std::floor(p.z()));
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 offset(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
    const Vec3 at = base + offset, d = p - at;
    const LatticePoint& point =
        lattice_point({int64_t(at.x()), int64_t(at.y()), int64_t(at.z())}, seed);
    const Mat3 G = flow.cosine[point.phase] * point.first + flow.sine[point.phase] * point.second;
    Vec3 f, rate;
    for (int i = 0; i < 3; ++i) {
      const double t = std::fabs(d[i]);
      f[i] = fade(t);
      rate[i] = d[i] < 0 ? -fade_rate(t) : fade_rate(t);
    }
    const Vec3 slope(rate.x() * f.y() * f.z(), f.x() * rate.y() * f.z(), f.x() * f.y() * rate.z());
    const Vec3 curl(G(2, 1) - G(1, 2), G(0, 2) - G(2, 0), G(1, 0) - G(0, 1));
    sum += slope.cross(Vec3(G * d)) + f.x() * f.y() * f.z() * curl;
  }
  return sum;
}

}  // namespace

TurbulenceDef::Flow TurbulenceDef::at(double t) const {
  Flow flow{octaves, size, 0, seed, {}, {}};
  double power = 0;
  for (int i = 0; i < octaves; ++i) power += det::pow(0.5, 2.0 / 3 * i);
  flow.scale = speed / (tolerances::curl_rms * std::sqrt(power));
  const double turned = period > 0 ? 2 * det::pi * t / period : 0;
  for (int i = 0; i < phases; ++i) {
    const double angle = turned + 2 * det::pi * i / phases;
    flow.cosine[size_t(i)] = det::cos(angle);
    flow.sine[size_t(i)] = det::sin(angle);
  }
  return flow;
}

Vec3 TurbulenceDef::Flow::operator()(const Vec3& x) const {
  Vec3 sum = Vec3::Zero();
  double weight = scale, spacing = size;
  for (int i = 0; i < octaves; ++i) {
    const Vec3 p = x / spacing;
    if (!(p.cwiseAbs().maxCoeff() < tolerances::farthest_lattice)) return Vec3::Zero();
    sum += weight * curl_noise(p, mixed(seed + 0x9e3779b97f4a7c15ULL * uint64_t(i + 1)), *this);
    weight *= tolerances::octave_speed;
    spacing *= 0.5;
  }
  return sum;
}

}  // namespace tumble
