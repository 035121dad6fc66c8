#pragma once
#include "engine/core/random.hpp"
#include "engine/math/lcp/problem.hpp"

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
  const char* text = std::getenv("TUMBLE_TEST_SCALE");
  return std::max(1, int(n * (text ? std::atof(text) : 1.0)));
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

}  // namespace tumble::lcp_families
