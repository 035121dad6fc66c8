#pragma once
#include "engine/core/random.hpp"
#include "engine/math/lcp/problem.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

/// Families of linear complementarity problems for tests and benchmarks.
namespace tumble::lcp_families {

using lcp::LcpProblem;
using lcp::MatX;
using lcp::VecX;

constexpr double inf = std::numeric_limits<double>::infinity();

inline int count(int n) {
  return test::scaled_count(n);
}

inline double draw(Random& r, bool whole) {
  return whole ? double(int(r.below(7)) - 3) : r.uniform(-1, 1);
}

/// J J^T of a random n x rank J, of small whole numbers (exact, degenerate) or not.
inline MatX gram(Random& r, int n, int rank, bool whole) {
  MatX J(n, rank), A(n, n);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < rank; ++k) J(i, k) = draw(r, whole);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      double sum = 0;
      for (int k = 0; k < rank; ++k) sum += J(i, k) * J(j, k);
      A(i, j) = sum;
    }
  }
  return A;
}

/// A x in a fixed order.
inline VecX times(const MatX& A, const VecX& x) {
  VecX out = VecX::Zero(A.rows());
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    for (Eigen::Index i = 0; i < A.rows(); ++i) out[i] += A(i, j) * x[j];
  return out;
}

enum Family { definite, consistent, arbitrary, whole_numbers, bounded, mixed };
constexpr const char* family_names[] = {"definite",      "semi-definite, b in the range",
                                        "semi-definite", "whole numbers",
                                        "bounds",        "bounds and free unknowns"};

inline LcpProblem make(Random& r, int n, Family family) {
  const bool whole = family == whole_numbers || (family >= bounded && r.below(2));
  const int rank = family == definite ? n + 2 : 1 + int(r.below(uint32_t(n)));
  MatX A = gram(r, n, rank, whole);
  VecX b(n);
  for (int i = 0; i < n; ++i) b[i] = draw(r, whole);
  if (family == consistent || (family >= bounded && r.below(2))) b = times(A, b);
  LcpProblem p = LcpProblem::plain(std::move(A), std::move(b));
  for (int i = 0; i < n && family >= bounded; ++i) {
    switch (r.below(family == bounded ? 3 : 6)) {
      case 0:
        break;
      case 1:
        p.lower[i] = -double(r.below(3));
        p.upper[i] = p.lower[i] + double(r.below(4));
        break;
      case 2:
        p.lower[i] = -inf;
        p.upper[i] = double(r.below(3)) - 1;
        break;
      default:
        p.lower[i] = -inf;
    }
  }
  return p;
}

/// Other units for each unknown, within `decades` powers of ten on both sides.
inline void rescale(Random& r, LcpProblem& p, double decades) {
  for (int i = 0; i < p.size(); ++i) {
    const double d = std::pow(10.0, r.uniform(-decades, decades));
    p.A.row(i) *= d;
    p.A.col(i) *= d;
    p.b[i] *= d;
    p.lower[i] /= d;
    p.upper[i] /= d;
  }
  for (int i = 0; i < p.size(); ++i)
    for (int j = 0; j < i; ++j) p.A(i, j) = p.A(j, i);
}

/// A matrix some of whose rows depend on others but for a part of relative size `apart`, whose
/// square is what their smallest pivots are; with bounds of all kinds.
inline LcpProblem make_near_singular(Random& r, int n, double apart, bool in_range) {
  const int base = 1 + int(r.below(uint32_t(n)));
  MatX J = MatX::Zero(n, n + 2), A = MatX::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    const auto p = Eigen::Index(r.below(uint32_t(base))), q = Eigen::Index(r.below(uint32_t(base)));
    const double f = r.below(2) ? 1 : r.uniform(-1, 1), g = r.below(2) ? 0 : r.uniform(-1, 1);
    for (int k = 0; k < n + 2; ++k)
      J(i, k) = i < base ? r.uniform(-1, 1) : f * J(p, k) + g * J(q, k) + apart * r.uniform(-1, 1);
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      for (int k = 0; k < n + 2; ++k) A(i, j) += J(i, k) * J(j, k);
      A(j, i) = A(i, j);
    }
  VecX b(n);
  for (int i = 0; i < n; ++i) b[i] = draw(r, false);
  if (in_range) b = times(A, b);
  LcpProblem p = LcpProblem::plain(std::move(A), std::move(b));
  const auto kind = r.below(3);
  for (int i = 0; i < n && kind > 0; ++i) {
    if (r.below(2)) p.upper[i] = r.uniform(0, 2);
    if (kind == 2 && r.below(3) == 0) {
      p.lower[i] = -inf;
      p.upper[i] = inf;
    }
  }
  return p;
}

/// A column of `layers` unit cubes of mass 1 under gravity 9.81, four corners each on the one
/// below: unknown 4 k + c pushes at corner c of the underside of cube k, w is the relative
/// acceleration there. Vertical motion and tilting give each cube three freedoms: the rank is 3 per
/// layer.
inline LcpProblem column_of_boxes(int layers) {
  const double x[4] = {-0.5, 0.5, -0.5, 0.5}, z[4] = {-0.5, -0.5, 0.5, 0.5};
  MatX A = MatX::Zero(4 * layers, 4 * layers);
  VecX b = VecX::Zero(4 * layers);
  const auto pair = [&](int c, int e) { return 1 + 6 * (x[c] * x[e] + z[c] * z[e]); };
  for (int k = 0; k < layers; ++k) {
    for (int c = 0; c < 4; ++c) {
      for (int e = 0; e < 4; ++e) {
        A(4 * k + c, 4 * k + e) = (k > 0 ? 2 : 1) * pair(c, e);
        if (k > 0) A(4 * k + c, 4 * (k - 1) + e) = A(4 * (k - 1) + e, 4 * k + c) = -pair(c, e);
      }
    }
  }
  for (int c = 0; c < 4; ++c) b[c] = -9.81;
  return LcpProblem::plain(std::move(A), std::move(b));
}

/// The same column with a cone at each corner: three unknowns a corner, axial first, six freedoms a
/// cube.
inline LcpProblem boxes_with_cones(int layers, double slope) {
  const int n = 12 * layers;
  MatX J = MatX::Zero(n, 6 * layers);
  for (int k = 0; k < layers; ++k) {
    for (int c = 0; c < 4; ++c) {
      const double x = c % 2 ? 0.5 : -0.5, z = c / 2 ? 0.5 : -0.5;
      for (int below = 0; below < (k > 0 ? 2 : 1); ++below) {
        const double r[3] = {x, below ? 0.5 : -0.5, z}, sign = below ? -1 : 1;
        for (int a = 0; a < 3; ++a) {
          const double d[3] = {a == 1 ? 1.0 : 0.0, a == 0 ? 1.0 : 0.0, a == 2 ? 1.0 : 0.0};
          const int row = 12 * k + 3 * c + a, body = 6 * (k - below);
          for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, l = (i + 2) % 3;
            J(row, body + i) = sign * d[i];
            J(row, body + 3 + i) = sign * std::sqrt(6.0) * (r[j] * d[l] - r[l] * d[j]);
          }
        }
      }
    }
  }
  MatX A = MatX::Zero(n, n);
  VecX b = VecX::Zero(n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      for (int c = 0; c < 6 * layers; ++c) A(i, j) += J(i, c) * J(j, c);
      A(j, i) = A(i, j);
    }
  for (int c = 0; c < 4; ++c) b[3 * c] = -9.81;
  LcpProblem out = LcpProblem::plain(std::move(A), std::move(b));
  for (int i = 0; i < n; i += 3) {
    lcp::ConeGroup g;
    g.axial = i;
    g.lateral = {i + 1, i + 2};
    g.slope = slope;
    out.groups.push_back(g);
    for (const int t : g.lateral) out.lower[t] = -inf;
  }
  return out;
}

/// A rigid body of mass 1 and principal inertia `inertia` that touches planes at `points` (from its
/// centre) with normal y and laterals x, z, three unknowns each, under a force through the centre
/// and a torque: w is the acceleration of the points.
inline LcpProblem body_on_points(const std::vector<std::array<double, 3>>& points,
                                 std::array<double, 3> inertia, std::array<double, 3> force,
                                 std::array<double, 3> torque, double slope,
                                 lcp::ConeShape shape = lcp::ConeShape::circular) {
  const int k = int(points.size()), n = 3 * k;
  MatX J = MatX::Zero(n, 6);
  for (int p = 0; p < k; ++p) {
    const auto& r = points[size_t(p)];
    const double axis[3][3] = {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
    for (int a = 0; a < 3; ++a) {
      const double* d = axis[a];
      for (int c = 0; c < 3; ++c) J(3 * p + a, c) = d[c];
      J(3 * p + a, 3) = r[1] * d[2] - r[2] * d[1];
      J(3 * p + a, 4) = r[2] * d[0] - r[0] * d[2];
      J(3 * p + a, 5) = r[0] * d[1] - r[1] * d[0];
    }
  }
  MatX A = MatX::Zero(n, n);
  VecX b = VecX::Zero(n);
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < 6; ++c) {
      const double f = c < 3 ? 1 : 1 / inertia[size_t(c - 3)];
      for (int j = 0; j < n; ++j) A(i, j) += J(i, c) * J(j, c) * f;
      b[i] += J(i, c) * f * (c < 3 ? force[size_t(c)] : torque[size_t(c - 3)]);
    }
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) A(i, j) = A(j, i);
  LcpProblem out = LcpProblem::plain(std::move(A), std::move(b));
  for (int p = 0; p < k; ++p) {
    lcp::ConeGroup g;
    g.axial = 3 * p;
    g.lateral = {3 * p + 1, 3 * p + 2};
    g.slope = slope;
    g.shape = shape;
    out.groups.push_back(g);
    for (const int t : g.lateral) out.lower[t] = -inf;
  }
  return out;
}

/// Groups on a random semi-definite matrix; with `in_range` b = -A x for an x within the cones, so
/// that there is a solution.
inline LcpProblem make_cones(Random& r, int k, bool definite_matrix, bool in_range,
                             lcp::ConeShape shape, lcp::ConeMode mode, double steepest) {
  const int n = 3 * k;
  LcpProblem p = LcpProblem::plain(
      gram(r, n, definite_matrix ? n + 3 : 1 + int(r.below(uint32_t(n))), false), VecX(n));
  VecX x(n);
  for (int g = 0; g < k; ++g) {
    lcp::ConeGroup c;
    c.axial = 3 * g;
    c.lateral = {3 * g + 1, 3 * g + 2};
    c.slope = r.uniform(0, steepest);
    c.shape = shape;
    c.mode = mode;
    const double angle = r.uniform(0, 6.3), part = r.uniform(0, 0.9);
    c.direction = {std::cos(angle), std::sin(angle)};
    p.groups.push_back(c);
    x[3 * g] = -r.uniform(0.1, 1);
    for (size_t t = 0; t < 2; ++t) {
      p.lower[c.lateral[t]] = -inf;
      x[c.lateral[t]] = part * c.slope * x[3 * g] * c.direction[t];
    }
  }
  for (int i = 0; i < n; ++i) p.b[i] = draw(r, false);
  if (in_range) p.b = times(p.A, x);
  return p;
}

}  // namespace tumble::lcp_families
