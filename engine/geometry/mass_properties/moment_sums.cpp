#include "engine/geometry/mass_properties/moment_sums.hpp"

#include "engine/math/double_double.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#if defined(__x86_64__)
#define TUMBLE_MOMENTS_AVX2 1
#endif

namespace tumble {
namespace {

/// Four doubles, an operation on all at once. The compiler makes one or two instructions of it: a
/// lane's bits do not depend on which.
using Lanes = double __attribute__((vector_size(32)));
// (A typedef: clang heeds the lower alignment only there.)
typedef double LanePair __attribute__((vector_size(16), aligned(8), may_alias));
using LaneBits = long long __attribute__((vector_size(32)));

constexpr size_t lane_count = 4, block_triangles = 128, sum_count = 12;
using BlockSums = std::array<double, sum_count>;

/// Sums of one block; lanes are added last. The sizes are taken of the batches whose number agrees
/// with `chosen` in the bits of `mask`. Inlined into functions for different instruction sets.
[[gnu::always_inline]] inline void add_block(const Vec3* vertices, const Triangle* triangles,
                                             const Vec3& origin, size_t chosen, size_t mask,
                                             BlockSums& out) {
  const LaneBits positive = LaneBits{} + 0x7fffffffffffffffll;
  const double ox = origin.x(), oy = origin.y(), oz = origin.z();
  Lanes sums[sum_count] = {};
  for (size_t first = 0; first < block_triangles; first += lane_count) {
    const Triangle* t = triangles + first;
    Lanes x[3], y[3], z[3];
    for (size_t k = 0; k < 3; ++k) {
      const double *p = vertices[t[0][k]].data(), *q = vertices[t[1][k]].data(),
                   *r = vertices[t[2][k]].data(), *s = vertices[t[3][k]].data();
      // x and y come together.
      const Lanes even = __builtin_shufflevector(*reinterpret_cast<const LanePair*>(p),
                                                 *reinterpret_cast<const LanePair*>(r), 0, 1, 2, 3);
      const Lanes odd = __builtin_shufflevector(*reinterpret_cast<const LanePair*>(q),
                                                *reinterpret_cast<const LanePair*>(s), 0, 1, 2, 3);
      x[k] = __builtin_shufflevector(even, odd, 0, 4, 2, 6) - ox;
      y[k] = __builtin_shufflevector(even, odd, 1, 5, 3, 7) - oy;
      z[k] = Lanes{p[2], q[2], r[2], s[2]} - oz;
    }
    // Six times the volume of the tetrahedron, from two sides, so that small triangles lose nothing
    // to cancellation.
    const Lanes ux = x[1] - x[0], uy = y[1] - y[0], uz = z[1] - z[0];
    const Lanes vx = x[2] - x[0], vy = y[2] - y[0], vz = z[2] - z[0];
    const Lanes yz = uy * vz, zy = uz * vy, zx = uz * vx, xz = ux * vz, xy = ux * vy, yx = uy * vx;
    const Lanes d = (x[0] * (yz - zy) + y[0] * (zx - xz)) + z[0] * (xy - yx);
    // Sums of two corners p, q, r: a a^T + b b^T + c c^T + s s^T = p p^T + q q^T + r r^T.
    const Lanes px = x[0] + x[1], py = y[0] + y[1], pz = z[0] + z[1];
    const Lanes qx = x[1] + x[2], qy = y[1] + y[2], qz = z[1] + z[2];
    const Lanes rx = x[2] + x[0], ry = y[2] + y[0], rz = z[2] + z[0];
    const Lanes xx = (px * px + qx * qx) + rx * rx, yy = (py * py + qy * qy) + ry * ry,
                zz = (pz * pz + qz * qz) + rz * rz;
    sums[0] += d;
    sums[1] += d * (px + x[2]);
    sums[2] += d * (py + y[2]);
    sums[3] += d * (pz + z[2]);
    sums[4] += d * xx;
    sums[5] += d * yy;
    sums[6] += d * zz;
    sums[7] += d * ((px * py + qx * qy) + rx * ry);
    sums[8] += d * ((py * pz + qy * qz) + ry * rz);
    sums[9] += d * ((pz * px + qz * qx) + rz * rx);
    if (((first / lane_count) ^ chosen) & mask) continue;
    const Lanes parts[9] = {x[0], y[0], z[0], yz, zy, zx, xz, xy, yx};
    Lanes m[9];  // their magnitudes
    for (size_t k = 0; k < 9; ++k) m[k] = Lanes(LaneBits(parts[k]) & positive);
    const Lanes size = (m[0] * (m[3] + m[4]) + m[1] * (m[5] + m[6])) + m[2] * (m[7] + m[8]);
    sums[10] += size;
    sums[11] += size * (xx + yy + zz);
  }
  for (size_t k = 0; k < sum_count; ++k) {
    out[k] = (sums[k][0] + sums[k][1]) + (sums[k][2] + sums[k][3]);
  }
}

/// Sums of blocks with the rounding of each addition kept aside.
struct CompensatedSums {
  BlockSums high{}, low{};

  [[gnu::always_inline]] void add(const BlockSums& x) {
    for (size_t k = 0; k < sum_count; ++k) {
      double rest = 0;
      two_sum(high[k], x[k], high[k], rest);
      low[k] += rest;
    }
  }
};

/// Of large meshes a quarter of the batches says how large rounding is, a different one from block
/// to block so that no regularity of the mesh escapes.
size_t size_mask(size_t triangles) {
  return triangles < 4096 ? 0 : 3;
}

[[gnu::always_inline]] inline void add_all(const TriangleMesh& mesh, const Vec3& origin,
                                           CompensatedSums& out) {
  BlockSums block;
  const Vec3* vertices = mesh.vertices.data();
  const size_t n = mesh.triangles.size(), whole = n / block_triangles * block_triangles;
  const size_t mask = size_mask(n);
  for (size_t t = 0; t < whole; t += block_triangles) {
    add_block(vertices, mesh.triangles.data() + t, origin, t / block_triangles, mask, block);
    out.add(block);
  }
  if (whole == n) return;
  // The rest is filled up with triangles that are points, whose terms are zeros.
  std::array<Triangle, block_triangles> rest;
  const uint32_t any = mesh.triangles[whole][0];
  rest.fill({any, any, any});
  std::copy(mesh.triangles.begin() + std::ptrdiff_t(whole), mesh.triangles.end(), rest.begin());
  add_block(vertices, rest.data(), origin, whole / block_triangles, mask, block);
  out.add(block);
}

void add_all_baseline(const TriangleMesh& mesh, const Vec3& origin, CompensatedSums& out) {
  add_all(mesh, origin, out);
}

#ifdef TUMBLE_MOMENTS_AVX2
__attribute__((target("avx2"))) void add_all_avx2(const TriangleMesh& mesh, const Vec3& origin,
                                                  CompensatedSums& out) {
  add_all(mesh, origin, out);
}
/// Four lanes as well, but twice the registers.
__attribute__((target("avx2,avx512f,avx512vl,avx512dq"))) void add_all_avx512vl(
    const TriangleMesh& mesh, const Vec3& origin, CompensatedSums& out) {
  add_all(mesh, origin, out);
}
#endif

// -- the same with twice the digits ---------------------------------------------------------------

DoubleDouble quotient(DoubleDouble a, DoubleDouble b) {
  const double q = a.high / b.high;
  const DoubleDouble rest = a - b * DoubleDouble{q, 0};
  const double r = rest.high / b.high;
  DoubleDouble out;
  two_sum(q, r, out.high, out.low);
  return out;
}

using PreciseVec = std::array<DoubleDouble, 3>;

PreciseVec from_origin(const Vec3& p, const Vec3& origin) {
  PreciseVec out;
  for (size_t k = 0; k < 3; ++k) two_sum(p[int(k)], -origin[int(k)], out[k].high, out[k].low);
  return out;
}

PreciseVec operator-(const PreciseVec& a, const PreciseVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Places of a symmetric matrix: xx, yy, zz, xy, yz, zx.
constexpr std::array<std::array<size_t, 2>, 6> entries{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}}};

}  // namespace

MomentSums sum_moments(const TriangleMesh& mesh, const Vec3& origin, bool narrow) {
  CompensatedSums total;
#ifdef TUMBLE_MOMENTS_AVX2
  static const bool avx2 = __builtin_cpu_supports("avx2");
  static const bool avx512vl =
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
  if (avx512vl && !narrow) {
    add_all_avx512vl(mesh, origin, total);
  } else if (avx2 && !narrow) {
    add_all_avx2(mesh, origin, total);
  } else {
    add_all_baseline(mesh, origin, total);
  }
#else
  (void)narrow;
  add_all_baseline(mesh, origin, total);
#endif
  BlockSums s;
  for (size_t k = 0; k < sum_count; ++k) s[k] = total.high[k] + total.low[k];
  MomentSums out;
  out.volume6 = s[0];
  out.moment24 = {s[1], s[2], s[3]};
  for (size_t e = 0; e < 6; ++e) {
    const auto [i, j] = entries[e];
    out.second120(int(i), int(j)) = out.second120(int(j), int(i)) = s[4 + e];
  }
  const auto share = double(size_mask(mesh.triangles.size()) + 1);
  out.size6 = share * s[10];
  out.size120 = share * s[11];
  return out;
}

SolidMoments moments_about_centre(const MomentSums& sums, const Vec3& origin) {
  SolidMoments out;
  out.volume = sums.volume6 / 6;
  out.centre = origin;
  if (sums.volume6 == 0) return out;
  const Vec3 centre = sums.moment24 / (4 * sums.volume6);
  const Mat3 second = sums.second120 / 120 - out.volume * centre * centre.transpose();
  out.centre = origin + centre;
  out.inertia = second.trace() * Mat3::Identity() - second;
  return out;
}

bool too_rough(const MomentSums& sums, const SolidMoments& moments, const Vec3& origin) {
  // Each term passes about eight roundings of 1.1e-16 of its size.
  constexpr double rounding = 8 * 1.1e-16, allowed = 1e-14;
  const double offset = (moments.centre - origin).squaredNorm();
  const double trace = 0.5 * moments.inertia.trace() * (moments.volume < 0 ? -1 : 1);
  const bool volume_fine = rounding * sums.size6 <= allowed * std::fabs(sums.volume6);
  const bool inertia_fine =
      rounding * (sums.size120 / 120 + sums.size6 / 6 * offset) <= allowed * trace;
  return !(volume_fine && inertia_fine);
}

SolidMoments precise_moments(const TriangleMesh& mesh, const Vec3& origin) {
  DoubleDouble volume6;
  PreciseVec moment{};
  std::array<DoubleDouble, 6> second{};
  for (const Triangle& t : mesh.triangles) {
    const PreciseVec a = from_origin(mesh.vertices[t[0]], origin),
                     b = from_origin(mesh.vertices[t[1]], origin),
                     c = from_origin(mesh.vertices[t[2]], origin);
    const PreciseVec u = b - a, v = c - a;
    const DoubleDouble d = a[0] * (u[1] * v[2] - u[2] * v[1]) + a[1] * (u[2] * v[0] - u[0] * v[2]) +
                           a[2] * (u[0] * v[1] - u[1] * v[0]);
    const PreciseVec s{a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]};
    volume6 = volume6 + d;
    for (size_t k = 0; k < 3; ++k) moment[k] = moment[k] + d * s[k];
    for (size_t e = 0; e < 6; ++e) {
      const auto [i, j] = entries[e];
      second[e] = second[e] + d * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j]);
    }
  }
  SolidMoments out;
  out.volume = volume6.high / 6;
  out.centre = origin;
  if (volume6.high == 0) return out;
  PreciseVec centre;
  for (size_t k = 0; k < 3; ++k) {
    centre[k] = quotient(moment[k], volume6 * DoubleDouble{4, 0});
    out.centre[int(k)] = (DoubleDouble{origin[int(k)], 0} + centre[k]).high;
  }
  Mat3 about;
  for (size_t e = 0; e < 6; ++e) {
    const auto [i, j] = entries[e];
    const DoubleDouble moved = second[e] - volume6 * DoubleDouble{20, 0} * (centre[i] * centre[j]);
    about(int(i), int(j)) = about(int(j), int(i)) = moved.high / 120;
  }
  out.inertia = about.trace() * Mat3::Identity() - about;
  return out;
}

}  // namespace tumble
