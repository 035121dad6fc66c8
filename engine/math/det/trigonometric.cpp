#include "engine/math/det/det.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

// Argument reduction by a three-part pi/2 (Cody and Waite 1980, ch. 8), then Taylor series on
// [-pi/4, pi/4], whose first dropped term is below 1e-19.
namespace tumble::det {
namespace {

constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
constexpr double half_pi_1 = 0x1.921fb544p+0;
constexpr double half_pi_2 = 0x1.0b4611a6p-34;
constexpr double half_pi_3 = 0x1.3198a2e037073p-69;

/// x = n pi/2 + r + r_low with |r| <= pi/4; gives n modulo 4.
struct Reduced {
  double r, r_low;
  int quadrant;
};

Reduced reduce(double x) {
  // Far out the products below are no longer exact; the remainder by 2 pi as a double is, so that
  // the pair of sine and cosine stays on the circle whatever the argument.
  if (std::fabs(x) > 1e6) x = std::fmod(x, 2 * pi);
  const double n = std::floor(x * two_over_pi + 0.5);
  const double a = x - n * half_pi_1;  // exact for |n| < 2^20
  const double b = n * half_pi_2;
  const double high = a - b;
  const double low = (a - high) - b - n * half_pi_3;
  const double r = high + low;
  return {r, (high - r) + low, int(int64_t(n) & 3)};
}

double sin_series(double r, double low) {
  const double z = r * r;
  double p = 1.0 / 355687428096000.0;
  p = 1.0 / -1307674368000.0 + z * p;
  p = 1.0 / 6227020800.0 + z * p;
  p = 1.0 / -39916800.0 + z * p;
  p = 1.0 / 362880.0 + z * p;
  p = 1.0 / -5040.0 + z * p;
  p = 1.0 / 120.0 + z * p;
  p = 1.0 / -6.0 + z * p;
  return r + (r * z * p + low * (1 - 0.5 * z));
}

double cos_series(double r, double low) {
  const double z = r * r;
  double p = 1.0 / -6402373705728000.0;
  p = 1.0 / 20922789888000.0 + z * p;
  p = 1.0 / -87178291200.0 + z * p;
  p = 1.0 / 479001600.0 + z * p;
  p = 1.0 / -3628800.0 + z * p;
  p = 1.0 / 40320.0 + z * p;
  p = 1.0 / -720.0 + z * p;
  p = 1.0 / 24.0 + z * p;
  const double half = 0.5 * z, first = 1 - half;
  return first + (((1 - first) - half) + (z * z * p - r * low));
}

bool reducible(double x) {
  return std::fabs(x) < 4503599627370496.0;
}

}  // namespace

double sin(double x) {
  if (!reducible(x)) return std::numeric_limits<double>::quiet_NaN();
  const Reduced a = reduce(x);
  const double v = (a.quadrant & 1) ? cos_series(a.r, a.r_low) : sin_series(a.r, a.r_low);
  return (a.quadrant & 2) ? -v : v;
}

double cos(double x) {
  if (!reducible(x)) return std::numeric_limits<double>::quiet_NaN();
  const Reduced a = reduce(x);
  const double v = (a.quadrant & 1) ? sin_series(a.r, a.r_low) : cos_series(a.r, a.r_low);
  return (a.quadrant == 1 || a.quadrant == 2) ? -v : v;
}

}  // namespace tumble::det
