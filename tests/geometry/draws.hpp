#pragma once
#include "engine/core/random.hpp"
#include "engine/math/types.hpp"
#include "tests/support/scale.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

/// Random geometric objects for tests, from our own conversion of random bits.
namespace tumble::draws {

/// `n` scaled by the environment variable TUMBLE_TEST_SCALE (default 1), at least 1.
inline int count(int n) {
  return test::scaled_count(n);
}

inline Vec3 in_box(Random& r, double half) {
  const double x = r.uniform(-half, half), y = r.uniform(-half, half), z = r.uniform(-half, half);
  return {x, y, z};
}

inline Vec3 direction(Random& r) {
  for (;;) {
    const Vec3 v = in_box(r, 1);
    const double square = v.squaredNorm();
    if (square > 1e-4 && square <= 1) return v / std::sqrt(square);
  }
}

inline Quat rotation(Random& r) {
  for (;;) {
    const Vec3 v = in_box(r, 1);
    const double w = r.uniform(-1, 1), square = v.squaredNorm() + w * w;
    if (square > 1e-4 && square <= 1) return Quat(w, v.x(), v.y(), v.z()).normalized();
  }
}

inline std::vector<Vec3> points(Random& r, uint32_t n) {
  std::vector<Vec3> out;
  for (uint32_t i = 0; i < n; ++i) out.push_back(in_box(r, 1));
  return out;
}

inline std::array<Vec3, 3> triangle(Random& r, double half = 1) {
  const Vec3 a = in_box(r, half), b = in_box(r, half), c = in_box(r, half);
  return {a, b, c};
}

}  // namespace tumble::draws
