#include "engine/math/det/det.hpp"

#include <cmath>
#include <limits>

// exp by reduction with a two-part ln 2 and a Taylor series; log by the series of
// 2 artanh((m - 1) / (m + 1)). pow carries log2-like extra bits in a second double.
namespace tumble::det {
namespace {

constexpr double ln2_high = 0x1.62e42fefp-1;
constexpr double ln2_low = 0x1.473de6af278edp-34;
constexpr double one_over_ln2 = 0x1.71547652b82fep+0;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// exp(x + low) for a small `low`.
double exp_sum(double x, double low) {
  if (std::isnan(x)) return x;
  if (x > 709.79) return infinity;
  if (x < -745.2) return 0;
  const double n = std::floor(x * one_over_ln2 + 0.5);
  const double high = x - n * ln2_high;
  const double rest = low - n * ln2_low;
  const double r = high + rest;
  const double r_low = (high - r) + rest;
  double p = 1.0 / 87178291200.0;
  p = 1.0 / 6227020800.0 + r * p;
  p = 1.0 / 479001600.0 + r * p;
  p = 1.0 / 39916800.0 + r * p;
  p = 1.0 / 3628800.0 + r * p;
  p = 1.0 / 362880.0 + r * p;
  p = 1.0 / 40320.0 + r * p;
  p = 1.0 / 5040.0 + r * p;
  p = 1.0 / 720.0 + r * p;
  p = 1.0 / 120.0 + r * p;
  p = 1.0 / 24.0 + r * p;
  p = 1.0 / 6.0 + r * p;
  p = 0.5 + r * p;
  const double v = 1 + (r + (r * r * p + r_low));
  return std::ldexp(v, int(n));
}

/// The exact product a b as a sum of two doubles (Dekker 1971).
void two_product(double a, double b, double& high, double& low) {
  constexpr double split = 134217729.0;
  const double ta = split * a, a1 = ta - (ta - a), a2 = a - a1;
  const double tb = split * b, b1 = tb - (tb - b), b2 = b - b1;
  high = a * b;
  low = ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2;
}

/// log(x) = high + low for finite x > 0.
void log_sum(double x, double& high, double& low) {
  int e;
  double m = std::frexp(x, &e);
  if (m < 0.70710678118654752) {
    m *= 2;
    --e;
  }
  const double num = m - 1, den = m + 1;  // num is exact
  const double den_low = (m - den) + 1;
  const double s = num / den;
  double p_high, p_low;
  two_product(s, den, p_high, p_low);
  const double s_low = ((num - p_high) - p_low - s * den_low) / den;
  const double z = s * s;
  double p = 1.0 / 23;
  for (int k = 21; k >= 3; k -= 2) p = 1.0 / k + z * p;
  const double tail = 2 * s * z * p + 2 * s_low;
  const double a = e * ln2_high, b = 2 * s;
  const double sum = a + b;
  const double error = std::fabs(a) >= std::fabs(b) ? b - (sum - a) : a - (sum - b);
  const double rest = error + tail + e * ln2_low;
  high = sum + rest;
  low = rest - (high - sum);
}

}  // namespace

double exp(double x) {
  return exp_sum(x, 0);
}

double log(double x) {
  if (std::isnan(x) || x < 0) return nan;
  if (x == 0) return -infinity;
  if (std::isinf(x)) return x;
  double high, low;
  log_sum(x, high, low);
  return high;
}

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (std::isnan(x) || std::isnan(y)) return nan;
  const bool integer = std::floor(y) == y;
  const bool odd = integer && std::fabs(y) < 9007199254740992.0 && std::fmod(y, 2) != 0;
  if (x < 0 && !integer && !std::isinf(x) && !std::isinf(y)) return nan;
  const double a = std::fabs(x);
  const double sign = std::signbit(x) && odd ? -1.0 : 1.0;
  if (a == 0) return y < 0 ? sign * infinity : sign * 0.0;
  if (std::isinf(a)) return y < 0 ? sign * 0.0 : sign * infinity;
  if (std::isinf(y)) return a == 1 ? 1 : ((a > 1) == (y > 0) ? infinity : 0);
  double high, low;
  log_sum(a, high, low);
  const double estimate = high * y;
  if (estimate > 710) return sign * infinity;
  if (estimate < -746) return sign * 0.0;
  double p, p_low;
  two_product(high, y, p, p_low);
  return sign * exp_sum(p, p_low + low * y);
}

}  // namespace tumble::det
