#pragma once
#include "engine/dynamics/joints/joint_part.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumble::folding {

/// Motion of a body or push on it: linear part, then angular part about its centre of mass.
using Six = std::array<double, 6>;
using Tensor = std::array<double, 36>;  ///< inertia of a body: symmetric, by column

constexpr size_t most_freedoms = 6;

inline Vec3 linear_of(const double* six) {
  return {six[0], six[1], six[2]};
}
inline Vec3 angular_of(const double* six) {
  return {six[3], six[4], six[5]};
}
inline void put(double* six, const Vec3& linear, const Vec3& angular) {
  for (int i = 0; i < 3; ++i) six[i] = linear[i], six[3 + i] = angular[i];
}

/// out += m v
inline void add_product(const Tensor& m, const double* v, double* out) {
  for (size_t c = 0; c < 6; ++c)
    for (size_t r = 0; r < 6; ++r) out[r] += m[6 * c + r] * v[c];
}

inline double dot(const double* a, const double* b) {
  double sum = 0;
  for (size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

/// To += X^T m X, for a body that is fixed to another one, with v = v' - r x omega'.
inline void add_moved(const Tensor& m, const Vec3& r, Tensor& to) {
  Tensor x = m;
  for (size_t i = 0; i < 6; ++i) {
    x[18 + i] += m[12 + i] * r[1] - m[6 + i] * r[2];
    x[24 + i] += m[i] * r[2] - m[12 + i] * r[0];
    x[30 + i] += m[6 + i] * r[0] - m[i] * r[1];
  }
  for (size_t c = 0; c < 6; ++c) {
    const double* const from = &x[6 * c];
    double* const out = &to[6 * c];
    out[0] += from[0], out[1] += from[1], out[2] += from[2];
    out[3] += from[3] + (r[1] * from[2] - r[2] * from[1]);
    out[4] += from[4] + (r[2] * from[0] - r[0] * from[2]);
    out[5] += from[5] + (r[0] * from[1] - r[1] * from[0]);
  }
}

/// The inverse of a positive definite n x n matrix by L D L^T. Pivots of at most `least` times
/// their diagonal entry are treated as infinite; returns a bit for each of these.
inline uint32_t invert(size_t n, const double* m, double least, double* inverse) {
  std::array<double, most_freedoms * most_freedoms> low;
  std::array<double, most_freedoms> pivot, over;
  uint32_t lost = 0;
  for (size_t c = 0; c < n; ++c) {
    pivot[c] = m[n * c + c];
    for (size_t k = 0; k < c; ++k) pivot[c] -= low[n * k + c] * low[n * k + c] * pivot[k];
    if (!(pivot[c] > least * m[n * c + c])) lost |= 1u << c, pivot[c] = 0;
    over[c] = pivot[c] > 0 ? 1 / pivot[c] : 0;
    for (size_t r = c + 1; r < n; ++r) {
      double v = m[n * c + r];
      for (size_t k = 0; k < c; ++k) v -= low[n * k + c] * low[n * k + r] * pivot[k];
      low[n * c + r] = v * over[c];
    }
  }
  for (size_t c = 0; c < n; ++c) {
    double* const x = inverse + n * c;
    for (size_t r = 0; r < n; ++r) {
      x[r] = r == c ? 1 : 0;
      for (size_t k = c; k < r; ++k) x[r] -= low[n * k + r] * x[k];
    }
    for (size_t r = c; r < n; ++r) x[r] *= over[r];
    for (size_t r = n; r-- > 0;)
      for (size_t k = r + 1; k < n; ++k) x[r] -= low[n * r + k] * x[k];
  }
  return lost;
}

/// The tensor of a body. `inertia` by column; the mean of the entries above and below the diagonal
/// is used.
inline void set_tensor(double mass, const double* inertia, Tensor& out) {
  out.fill(0);
  for (size_t i = 0; i < 3; ++i) {
    out[7 * i] = mass;
    for (size_t k = 0; k < 3; ++k)
      out[6 * (3 + i) + 3 + k] = 0.5 * (inertia[3 * i + k] + inertia[3 * k + i]);
  }
}

/// Masses of the bodies by block, with the inertias where they are known.
struct Bodies {
  std::span<const DofBlock> blocks;
  std::span<const Mat3> inertias;

  /// The tensor of a body by itself. Unknown inertias are inverted by L D L^T and not by cofactors,
  /// whose determinant would lose accuracy with the square of the ratio of the moments of inertia.
  void tensor(uint32_t block, Tensor& out) const {
    const DofBlock& of = blocks[block];
    if (!inertias.empty()) return set_tensor(1 / of.inverse_mass, inertias[block].data(), out);
    std::array<double, 9> inertia;
    invert(3, of.inverse_inertia.data(), 0, inertia.data());
    set_tensor(1 / of.inverse_mass, inertia.data(), out);
  }
};

}  // namespace tumble::folding
