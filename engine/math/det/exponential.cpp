#include "engine/math/det/det.hpp"
#include "engine/math/double_double.hpp"

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

/// log(x) for finite x > 0 to about 2^-68 relative, which pow needs: 2 artanh(s) with
/// s = (m - 1) / (m + 1), whose first terms are summed in double-double.
DoubleDouble log_sum(double x) {
  int e;
  double m = std::frexp(x, &e);
  if (m < 0.70710678118654752) {
    m *= 2;
    --e;
  }
  const double num = m - 1;  // exact
  double den, den_low;
  two_sum(m, 1, den, den_low);
  DoubleDouble s{num / den, 0};
  double p_high, p_low;
  two_product(s.high, den, p_high, p_low);
  s.low = ((num - p_high) - p_low - s.high * den_low) / den;
  const DoubleDouble z = s * s;
  double q = 1.0 / 25;
  for (int k = 23; k >= 7; k -= 2) q = 1.0 / k + z.high * q;
  constexpr DoubleDouble third{1.0 / 3, 0x1.5555555555555p-56};
  constexpr DoubleDouble fifth{0.2, -0x1.999999999999ap-57};
  const DoubleDouble z2 = z * z;
  const DoubleDouble series = third * z + (fifth * z2 + DoubleDouble{z2.high * z.high * q, 0});
  const DoubleDouble twice{2 * s.high, 2 * s.low};
  return DoubleDouble{e * ln2_high, e * ln2_low} + (twice + twice * series);
}

}  // namespace

double exp(double x) {
  return exp_sum(x, 0);
}

double log(double x) {
  if (std::isnan(x) || x < 0) return nan;
  if (x == 0) return -infinity;
  if (std::isinf(x)) return x;
  return log_sum(x).high;
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
  const auto [high, low] = log_sum(a);
  const double estimate = high * y;
  if (estimate > 710) return sign * infinity;
  if (estimate < -746) return sign * 0.0;
  double p, p_low;
  two_product(high, y, p, p_low);
  return sign * exp_sum(p, p_low + low * y);
}

}  // namespace tumble::det
