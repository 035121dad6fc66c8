#include "engine/math/det/det.hpp"
#include "engine/math/double_double.hpp"

#include <cmath>
#include <limits>

// atan(x) = atan(c) + atan((x - c) / (1 + x c)) with the nearest c = k/8, then the Taylor series
// for an argument of at most 1/16. The table holds atan(k/8) as a sum of two doubles.
namespace tumble::det {
namespace {

constexpr double table_high[9] = {0x0.0p+0,
                                  0x1.fd5ba9aac2f6ep-4,
                                  0x1.f5b75f92c80ddp-3,
                                  0x1.6f61941e4def1p-2,
                                  0x1.dac670561bb4fp-2,
                                  0x1.1e00babdefeb4p-1,
                                  0x1.4978fa3269ee1p-1,
                                  0x1.700a7c5784634p-1,
                                  0x1.921fb54442d18p-1};
constexpr double table_low[9] = {0x0.0p+0,
                                 -0x1.cd37686760c17p-59,
                                 0x1.8ab6e3cf7afbdp-57,
                                 -0x1.c63aae6f6e918p-56,
                                 0x1.a2b7f222f65e2p-56,
                                 -0x1.928df287a668fp-58,
                                 0x1.2419a87f2a458p-56,
                                 -0x1.8c34d25aadef6p-56,
                                 0x1.1a62633145c07p-55};

/// atan(x + low) for 0 <= x <= 1 and a small `low`.
double atan_unit(double x, double low) {
  const int k = int(x * 8 + 0.5);
  const double c = k * 0.125;
  double product, product_low, den, den_low;
  two_product(x, c, product, product_low);
  two_sum(1, product, den, den_low);
  const double num = x - c;  // exact
  const double r = num / den;
  double back, back_low;
  two_product(r, den, back, back_low);
  const double r_low = (((num - back) - back_low) - r * (den_low + product_low)) / den;
  const double z = r * r;
  double p = -1.0 / 15;
  p = 1.0 / 13 + z * p;
  p = -1.0 / 11 + z * p;
  p = 1.0 / 9 + z * p;
  p = -1.0 / 7 + z * p;
  p = 1.0 / 5 + z * p;
  p = -1.0 / 3 + z * p;
  const double rest = r * z * p + (r_low + low / (1 + x * x)) + table_low[k];
  double high, high_low;
  two_sum(table_high[k], r, high, high_low);
  return high + (high_low + rest);
}

/// atan(a / b) for 0 <= a <= b, b > 0.
double atan_ratio(double a, double b) {
  const double q = a / b;
  // The remainder of the division, where its products neither overflow nor underflow.
  if (!(b > 1e-140 && b < 1e140 && q > 1e-100)) return atan_unit(q, 0);
  double back, back_low;
  two_product(q, b, back, back_low);
  return atan_unit(q, ((a - back) - back_low) / b);
}

constexpr double half_pi_high = 0x1.921fb54442d18p+0;
constexpr double half_pi_low = 0x1.1a62633145c07p-54;

}  // namespace

double atan(double x) {
  const double a = std::fabs(x);
  if (std::isnan(x)) return x;
  const double v = a <= 1 ? atan_unit(a, 0) : half_pi_high - (atan_ratio(1, a) - half_pi_low);
  return std::copysign(v, x);
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  const double ax = std::fabs(x), ay = std::fabs(y);
  double v;
  if (ax == 0 && ay == 0) {
    v = 0;
  } else if (std::isinf(ax) && std::isinf(ay)) {
    v = 0.5 * half_pi_high;
  } else if (ay <= ax) {
    v = atan_ratio(ay, ax);
  } else {
    v = half_pi_high - (atan_ratio(ax, ay) - half_pi_low);
  }
  if (std::signbit(x)) v = pi - (v - 2 * half_pi_low);
  return std::copysign(v, y);
}

namespace {

/// sqrt(1 - x^2) as a sum of two doubles, for |x| <= 1.
DoubleDouble other_leg(double x) {
  double square, square_low;
  two_product(x, x, square, square_low);
  const double t = 1 - square, t_low = ((1 - t) - square) - square_low;
  const double r = std::sqrt(t);
  if (!(r > 0)) return {0, 0};
  double p, p_low;
  two_product(r, r, p, p_low);
  return {r, (((t - p) - p_low) + t_low) / (2 * r)};
}

}  // namespace

// The angle of a point on the unit circle turns by x dr when its leg r changes by dr.
double asin(double x) {
  if (!(std::fabs(x) <= 1)) return std::numeric_limits<double>::quiet_NaN();
  const DoubleDouble r = other_leg(x);
  return atan2(x, r.high) - x * r.low;
}

double acos(double x) {
  if (!(std::fabs(x) <= 1)) return std::numeric_limits<double>::quiet_NaN();
  const DoubleDouble r = other_leg(x);
  return atan2(r.high, x) + x * r.low;
}

}  // namespace tumble::det
