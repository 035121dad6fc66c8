#pragma once
#include <cstddef>

namespace tumble {

/// The digits of n in a base, mirrored at the point: in [0, 1). Of bases 2, 3, 5 ... these are the
/// points of a low-discrepancy sequence (Halton 1960), the same on every machine.
inline double radical_inverse(size_t n, size_t base) {
  double out = 0, digit = 1;
  for (; n > 0; n /= base) {
    digit /= double(base);
    out += digit * double(n % base);
  }
  return out;
}

}  // namespace tumble
