#pragma once
#include "engine/core/error.hpp"
#include "engine/geometry/continuous_tests/moving.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string>

/// What every continuous test of linearly moving points does with its input.
namespace tumble {

/// Largest coordinate, or infinity when one is not finite.
template <size_t n>
double largest_magnitude(const std::array<const MovingPoint*, n>& points) {
  Vec3 most = Vec3::Zero(), poison = Vec3::Zero();
  for (const MovingPoint* p : points) {
    most = most.cwiseMax(p->start.cwiseAbs()).cwiseMax(p->end.cwiseAbs());
    poison += 0 * p->start + 0 * p->end;  // NaN for what is not finite
  }
  if (!(poison.x() + poison.y() + poison.z() == 0)) return std::numeric_limits<double>::infinity();
  return most.maxCoeff();
}

/// Above this the differences of coordinates could overflow.
constexpr double largest_direct = 0x1p1000;

inline MovingPoint scaled(const MovingPoint& p, double factor) {
  return {factor * p.start, factor * p.end};
}

inline Error not_finite(const char* test) {
  return {ErrorCode::numeric, std::string(test) + ": a coordinate is not a finite number", "",
          "look for what made it infinite or NaN"};
}

inline Error bad_separation(const char* test, double separation) {
  return {ErrorCode::invalid_argument,
          std::string(test) + ": the separation must be >= 0 m, got " + std::to_string(separation),
          "", ""};
}

/// Whether some coordinate axis separates all of A from all of B by more than `separation` at both
/// ends, and so throughout. Exact: comparisons, and differences whose rounding is monotone.
template <size_t n, size_t m>
bool apart_along_axes(const std::array<const MovingPoint*, n>& a,
                      const std::array<const MovingPoint*, m>& b, double separation) {
  const auto range = [](const auto& points, Vec3 MovingPoint::*at, Vec3& low, Vec3& high) {
    low = high = points[0]->*at;
    for (size_t i = 1; i < points.size(); ++i) {
      low = low.cwiseMin(points[i]->*at);
      high = high.cwiseMax(points[i]->*at);
    }
  };
  Vec3 al0, ah0, al1, ah1, bl0, bh0, bl1, bh1;
  range(a, &MovingPoint::start, al0, ah0);
  range(a, &MovingPoint::end, al1, ah1);
  range(b, &MovingPoint::start, bl0, bh0);
  range(b, &MovingPoint::end, bl1, bh1);
  const Vec3 above = (al0 - bh0).cwiseMin(al1 - bh1), below = (bl0 - ah0).cwiseMin(bl1 - ah1);
  return above.cwiseMax(below).maxCoeff() > separation;
}

}  // namespace tumble
