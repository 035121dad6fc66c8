#include "engine/math/lcp/least/solution_cell.hpp"

#include "engine/math/lcp/scaling.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

using Point = SolutionCell::Point;
using Matrix = SolutionCell::Matrix;

/// Projection on the multiples (>= 0) of a vector.
Point on_ray(const Point& v, const Point& x, Matrix& j) {
  const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  const double f = (v[0] * x[0] + v[1] * x[1] + v[2] * x[2]) / square;
  j = {};
  if (f <= 0) return {};
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 3; ++c) j[r][c] = v[r] * v[c] / square;
  return {f * v[0], f * v[1], f * v[2]};
}

Point on_disc_cone(double slope, const Point& x, Matrix& j) {
  const double length = std::sqrt(x[1] * x[1] + x[2] * x[2]);
  if (length <= slope * x[0]) {
    j = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return x;
  }
  const double u = x[1] / length, v = x[2] / length;
  const Point out = on_ray({1, slope * u, slope * v}, x, j);
  if (out[0] <= 0) return out;
  // Across the cone's section the image turns with x.
  const double turn = slope * out[0] / length;
  j[1][1] += turn * v * v;
  j[2][2] += turn * u * u;
  j[1][2] -= turn * u * v;
  j[2][1] -= turn * u * v;
  return out;
}

/// Each lateral is inside, on one side, or on the other: returns the nearest admissible point of
/// all faces.
Point on_square_cone(const SolutionCell& s, const Point& x, Matrix& j) {
  Point best{};
  j = {};
  double least = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
  for (int first = -1; first <= 1; ++first) {
    for (int second = -1; second <= 1; ++second) {
      const std::array<int, 2> side{first, second};
      Point v{1, 0, 0};
      bool possible = true;
      for (size_t k = 0; k < 2; ++k) {
        if (s.tied[k] && side[k] != 1) possible = false;
        v[k + 1] = side[k] == 0 ? 0 : s.tied[k] ? s.tie[k] : side[k] * s.slope;
      }
      if (!possible) continue;
      Point along = x;
      for (size_t k = 0; k < 2; ++k)
        if (side[k] == 0) along[k + 1] = 0;
      Matrix own;
      Point out = on_ray(v, along, own);
      for (size_t k = 0; k < 2; ++k) {
        if (side[k] != 0) continue;
        out[k + 1] = x[k + 1];
        own[k + 1][k + 1] = 1;
        if (std::fabs(x[k + 1]) > s.slope * out[0] * (1 + tolerances::pyramid_rounding))
          possible = false;
      }
      if (!possible) continue;
      double apart = 0;
      for (size_t k = 0; k < 3; ++k) apart += (x[k] - out[k]) * (x[k] - out[k]);
      if (apart >= least) continue;
      least = apart;
      best = out;
      j = own;
    }
  }
  return best;
}

SolutionCell cell_of(const ConeGroup& g, const std::array<double, 3>& z,
                     const std::array<double, 3>& w, double still) {
  SolutionCell c;
  c.size = 3;
  c.unknown = {g.axial, g.lateral[0], g.lateral[1]};
  c.slope = g.slope;
  if (w[0] > still) {
    c.kind = SolutionCell::origin;
    return c;
  }
  const double length = std::sqrt(w[1] * w[1] + w[2] * w[2]);
  if (g.mode == ConeMode::sliding) {
    c.kind = SolutionCell::ray;
    c.tie = {-g.slope * g.direction[0], -g.slope * g.direction[1]};
  } else if (g.shape == ConeShape::pyramid) {
    c.kind = SolutionCell::square;
    for (size_t k = 0; k < 2; ++k) {
      c.tied[k] = std::fabs(w[k + 1]) > still;
      c.tie[k] = w[k + 1] > 0 ? -g.slope : g.slope;
    }
  } else if (length > still) {
    c.kind = SolutionCell::ray;
    // z_t and w_t are opposite: the one with less relative rounding error gives the direction.
    const double lateral = std::sqrt(z[1] * z[1] + z[2] * z[2]);
    const bool by_z = lateral > length;
    const double f = by_z ? g.slope / lateral : -g.slope / length;
    c.tie = {f * (by_z ? z[1] : w[1]), f * (by_z ? z[2] : w[2])};
  } else {
    c.kind = SolutionCell::disc;
  }
  return c;
}

}  // namespace

Point SolutionCell::project(const Point& x, Matrix& j) const {
  j = {};
  switch (kind) {
    case interval:
      if (x[0] > lower && x[0] < upper) j[0][0] = 1;
      return {std::clamp(x[0], lower, upper), 0, 0};
    case origin:
      return {};
    case ray:
      return on_ray({1, tie[0], tie[1]}, x, j);
    case disc:
      return on_disc_cone(slope, x, j);
    case square:
      break;
  }
  return on_square_cone(*this, x, j);
}

std::vector<SolutionCell> solution_cells(const LcpProblem& p, const VecX& z, const VecX& w,
                                         double still) {
  const std::vector<double> d = scaling_of(p);
  std::vector<SolutionCell> out;
  std::vector<bool> grouped(size_t(p.size()), false);
  for (const ConeGroup& g : p.groups) {
    const double u = d[size_t(g.axial)];
    out.push_back(cell_of(g, {z[g.axial] / u, z[g.lateral[0]] / u, z[g.lateral[1]] / u},
                          {w[g.axial] * u, w[g.lateral[0]] * u, w[g.lateral[1]] * u}, still));
    for (const int i : out.back().unknown) grouped[size_t(i)] = true;
  }
  for (int i = 0; i < p.size(); ++i) {
    if (grouped[size_t(i)]) continue;
    SolutionCell c;
    c.unknown[0] = i;
    const bool pressed = std::fabs(w[i]) * d[size_t(i)] > still;
    c.lower = pressed ? z[i] : p.lower[i];
    c.upper = pressed ? z[i] : p.upper[i];
    out.push_back(c);
  }
  return out;
}

}  // namespace tumble::lcp
