#include "engine/dynamics/forces/pair/pair_law.hpp"

#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

PairLaw::Value spline_at(const PairTable& t, double r) {
  // Before its first point and behind its last the table goes on in a straight line.
  const size_t last = t.r.size() - 2;
  const auto above = std::upper_bound(t.r.begin(), t.r.end(), r);
  const size_t k = std::min(size_t(std::max<ptrdiff_t>(0, above - t.r.begin() - 1)), last);
  const double h = t.r[k + 1] - t.r[k], b = std::clamp((r - t.r[k]) / h, 0.0, 1.0), a = 1 - b;
  const double slope =
      (t.energy[k + 1] - t.energy[k]) / h +
      ((3 * b * b - 1) * t.curvature[k + 1] - (3 * a * a - 1) * t.curvature[k]) * h / 6;
  double energy =
      a * t.energy[k] + b * t.energy[k + 1] +
      ((a * a * a - a) * t.curvature[k] + (b * b * b - b) * t.curvature[k + 1]) * h * h / 6;
  if (r < t.r.front()) energy += (r - t.r.front()) * slope;
  if (r > t.r.back()) energy += (r - t.r.back()) * slope;
  return {energy, -slope / r};
}

}  // namespace

PairTable::PairTable(std::vector<double> at, std::vector<double> values)
    : r(std::move(at)), energy(std::move(values)), curvature(r.size(), 0) {
  // Curvatures of the inner points from continuous slopes: a tridiagonal system (Thomas).
  const size_t n = r.size();
  std::vector<double> upper(n, 0);
  for (size_t k = 1; k + 1 < n; ++k) {
    const double below = r[k] - r[k - 1], above = r[k + 1] - r[k];
    const double right =
        6 * ((energy[k + 1] - energy[k]) / above - (energy[k] - energy[k - 1]) / below);
    const double pivot = 2 * (below + above) - below * upper[k - 1];
    upper[k] = above / pivot;
    curvature[k] = (right - below * curvature[k - 1]) / pivot;
  }
  for (size_t k = n; k-- > 1;)
    if (k + 1 < n) curvature[k] -= upper[k] * curvature[k + 1];
}

PairLaw::Value PairLaw::endless(double r2) const {
  switch (kind) {
    case Kind::lennard_jones: {
      const double s2 = length * length / r2, s6 = s2 * s2 * s2;
      return {4 * strength * (s6 * s6 - s6), 24 * strength * (2 * s6 * s6 - s6) / r2};
    }
    case Kind::inverse_distance: {
      const double d2 = r2 + length * length, energy = strength / std::sqrt(d2);
      return {energy, energy / d2};
    }
    case Kind::morse: {
      const double r = std::sqrt(r2), e = det::exp(-steepness * (r - length));
      return {strength * (e * e - 2 * e), 2 * strength * steepness * (e * e - e) / r};
    }
    case Kind::table:
      return spline_at(table, std::sqrt(r2));
  }
  return {};
}

PairLaw::Value PairLaw::at(double r2) const {
  if (!(r2 <= cutoff * cutoff)) return {};
  Value v = endless(r2);
  if (!ends()) return v;
  if (truncation == Truncation::shifted) {
    v.energy -= endless(cutoff * cutoff).energy;
  } else if (truncation == Truncation::smoothed) {
    const double r = std::sqrt(r2), width = cutoff - smooth_from;
    const double s = std::max(0.0, r - smooth_from) / width;
    const double keep = 1 - s * s * s * (10 - s * (15 - 6 * s));
    const double slope = -30 * s * s * (1 - s) * (1 - s) / width;
    v.push = v.push * keep - v.energy * slope / r;
    v.energy *= keep;
  }
  return v;
}

}  // namespace tumble
