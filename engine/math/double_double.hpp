#pragma once

/// Error-free transformations, and double-double numbers of about 106 bits.
namespace tumble {

/// a + b = high + low exactly (Knuth 1969).
inline void two_sum(double a, double b, double& high, double& low) {
  high = a + b;
  const double bv = high - a, av = high - bv;
  low = (a - av) + (b - bv);
}

/// a b = high + low exactly, barring overflow and underflow (Veltkamp; Dekker 1971).
inline void two_product(double a, double b, double& high, double& low) {
  constexpr double splitter = 134217729.0;  // 2^27 + 1
  const double ca = splitter * a, a1 = ca - (ca - a), a2 = a - a1;
  const double cb = splitter * b, b1 = cb - (cb - b), b2 = b - b1;
  high = a * b;
  low = a2 * b2 - (((high - a1 * b1) - a2 * b1) - a1 * b2);
}

/// The unevaluated sum high + low with |low| at most half an ulp of high.
struct DoubleDouble {
  double high = 0, low = 0;
};

inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  DoubleDouble s;
  two_sum(a.high, b.high, s.high, s.low);
  const double rest = s.low + (a.low + b.low), high = s.high + rest;
  return {high, rest - (high - s.high)};
}

inline DoubleDouble operator-(DoubleDouble a) {
  return {-a.high, -a.low};
}

inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) {
  return a + -b;
}

inline DoubleDouble operator*(DoubleDouble a, double b) {
  DoubleDouble p;
  two_product(a.high, b, p.high, p.low);
  const double rest = p.low + a.low * b, high = p.high + rest;
  return {high, rest - (high - p.high)};
}

inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  DoubleDouble p;
  two_product(a.high, b.high, p.high, p.low);
  const double rest = p.low + (a.high * b.low + a.low * b.high), high = p.high + rest;
  return {high, rest - (high - p.high)};
}

/// Within a few units of the 104th bit; b is not zero.
inline DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  const double q = a.high / b.high;
  const DoubleDouble rest = a - b * DoubleDouble{q, 0};
  DoubleDouble out;
  two_sum(q, rest.high / b.high, out.high, out.low);
  return out;
}

}  // namespace tumble
