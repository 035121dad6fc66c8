#include "engine/geometry/mass_properties/moment_blocks.hpp"

#include <cstring>

#if defined(__x86_64__)
#define TUMBLE_MOMENTS_AVX2 1
#endif

namespace tumble {
namespace {

/// Vectors of n doubles. Terms are computed for n triangles at a time and added to four lanes in
/// the order of the triangles, so that the bits of a lane do not depend on n.
template <size_t n>
struct Lanes {
  typedef double Values __attribute__((vector_size(8 * n)));
  typedef long long Bits __attribute__((vector_size(8 * n)));
};
using Pair = Lanes<2>::Values;
using Four = Lanes<4>::Values;
// (A typedef, since clang honours the lower alignment only there.)
typedef double LoosePair __attribute__((vector_size(16), aligned(8), may_alias));

constexpr size_t lane_count = 4;

/// Loads corner k of two or four triangles, relative to the origin. x and y are loaded together.
[[gnu::always_inline]] inline void load_corners(const Vec3* vertices, const Triangle* t, size_t k,
                                                const Vec3& origin, Pair& x, Pair& y, Pair& z) {
  const double *p = vertices[t[0][k]].data(), *q = vertices[t[1][k]].data();
  const Pair even = *reinterpret_cast<const LoosePair*>(p);
  const Pair odd = *reinterpret_cast<const LoosePair*>(q);
  x = __builtin_shufflevector(even, odd, 0, 2) - origin.x();
  y = __builtin_shufflevector(even, odd, 1, 3) - origin.y();
  z = Pair{p[2], q[2]} - origin.z();
}
[[gnu::always_inline]] inline void load_corners(const Vec3* vertices, const Triangle* t, size_t k,
                                                const Vec3& origin, Four& x, Four& y, Four& z) {
  const double *p = vertices[t[0][k]].data(), *q = vertices[t[1][k]].data(),
               *r = vertices[t[2][k]].data(), *s = vertices[t[3][k]].data();
  const Four even = __builtin_shufflevector(*reinterpret_cast<const LoosePair*>(p),
                                            *reinterpret_cast<const LoosePair*>(r), 0, 1, 2, 3);
  const Four odd = __builtin_shufflevector(*reinterpret_cast<const LoosePair*>(q),
                                           *reinterpret_cast<const LoosePair*>(s), 0, 1, 2, 3);
  x = __builtin_shufflevector(even, odd, 0, 4, 2, 6) - origin.x();
  y = __builtin_shufflevector(even, odd, 1, 5, 3, 7) - origin.y();
  z = Four{p[2], q[2], r[2], s[2]} - origin.z();
}

/// A sum in four lanes, to which terms of two triangles (lanes 0, 1 or 2, 3) or of four are added.
/// total4() adds the lanes of four sums: (0 + 1) + (2 + 3).
struct PairSum {
  Pair half[2] = {};
  [[gnu::always_inline]] void add(size_t part, const Pair& x) { half[part] += x; }
  [[gnu::always_inline]] static void total4(const PairSum& a, const PairSum& b, const PairSum& c,
                                            const PairSum& d, double* out) {
    const PairSum* all[4] = {&a, &b, &c, &d};
    for (size_t k = 0; k < 4; ++k) {
      const Pair *low = &all[k]->half[0], *high = &all[k]->half[1];
      out[k] = ((*low)[0] + (*low)[1]) + ((*high)[0] + (*high)[1]);
    }
  }
};
struct FourSum {
  Four all = {};
  [[gnu::always_inline]] void add(size_t, const Four& x) { all += x; }
  [[gnu::always_inline]] static void total4(const FourSum& a, const FourSum& b, const FourSum& c,
                                            const FourSum& d, double* out) {
    const Four ab = __builtin_shufflevector(a.all, b.all, 0, 4, 2, 6) +
                    __builtin_shufflevector(a.all, b.all, 1, 5, 3, 7);
    const Four cd = __builtin_shufflevector(c.all, d.all, 0, 4, 2, 6) +
                    __builtin_shufflevector(c.all, d.all, 1, 5, 3, 7);
    const Four sum =
        __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
    std::memcpy(out, &sum, sizeof sum);
  }
};

/// All sums, as named members instead of an array, so that the compiler keeps them in registers.
template <class Sum>
struct TermSums {
  Sum volume, x, y, z, xx, yy, zz, xy, yz, zx, size, size_squares;
};

/// Adds the terms of `n` triangles, and their magnitudes for the bound of rounding.
template <size_t n, class Sum>
[[gnu::always_inline]] inline void add_terms(const Vec3* vertices, const Triangle* triangles,
                                             const Vec3& origin, size_t part, TermSums<Sum>& sums) {
  using V = typename Lanes<n>::Values;
  using Bits = typename Lanes<n>::Bits;
  V x[3], y[3], z[3];
  for (size_t k = 0; k < 3; ++k) load_corners(vertices, triangles, k, origin, x[k], y[k], z[k]);
  // Six times the volume of the tetrahedron, from two sides, so that small triangles lose no digits
  // to cancellation.
  const V ux = x[1] - x[0], uy = y[1] - y[0], uz = z[1] - z[0];
  const V vx = x[2] - x[0], vy = y[2] - y[0], vz = z[2] - z[0];
  const V yz = uy * vz, zy = uz * vy, zx = uz * vx, xz = ux * vz, xy = ux * vy, yx = uy * vx;
  const V d = (x[0] * (yz - zy) + y[0] * (zx - xz)) + z[0] * (xy - yx);
  // With sums of two corners p, q, r and s of all three: a a^T + b b^T + c c^T + s s^T = p p^T + q
  // q^T + r r^T.
  const V px = x[0] + x[1], py = y[0] + y[1], pz = z[0] + z[1];
  const V qx = x[1] + x[2], qy = y[1] + y[2], qz = z[1] + z[2];
  const V rx = x[2] + x[0], ry = y[2] + y[0], rz = z[2] + z[0];
  const V xx = (px * px + qx * qx) + rx * rx, yy = (py * py + qy * qy) + ry * ry,
          zz = (pz * pz + qz * qz) + rz * rz;
  sums.volume.add(part, d);
  sums.x.add(part, d * (px + x[2]));
  sums.y.add(part, d * (py + y[2]));
  sums.z.add(part, d * (pz + z[2]));
  sums.xx.add(part, d * xx);
  sums.yy.add(part, d * yy);
  sums.zz.add(part, d * zz);
  sums.xy.add(part, d * ((px * py + qx * qy) + rx * ry));
  sums.yz.add(part, d * ((py * pz + qy * qz) + ry * rz));
  sums.zx.add(part, d * ((pz * px + qz * qx) + rz * rx));
  const Bits positive = Bits{} + 0x7fffffffffffffffll;
  const V parts[9] = {x[0], y[0], z[0], yz, zy, zx, xz, xy, yx};
  V m[9];  // their absolute values
  for (size_t k = 0; k < 9; ++k) m[k] = V(Bits(parts[k]) & positive);
  const V size = (m[0] * (m[3] + m[4]) + m[1] * (m[5] + m[6])) + m[2] * (m[7] + m[8]);
  sums.size.add(part, size);
  sums.size_squares.add(part, size * (xx + yy + zz));
}

/// Sums of one block; lanes are added at the end. Inlined into functions for different instruction
/// sets.
template <size_t n, class Sum>
[[gnu::always_inline]] inline void add_block(const Vec3* vertices, const Triangle* triangles,
                                             const Vec3& origin, BlockSums& out) {
  TermSums<Sum> sums;
  for (size_t first = 0; first < block_triangles; first += lane_count) {
    for (size_t k = 0; k < lane_count; k += n) {
      add_terms<n>(vertices, triangles + first + k, origin, k / n, sums);
    }
  }
  Sum::total4(sums.volume, sums.x, sums.y, sums.z, out.data());
  Sum::total4(sums.xx, sums.yy, sums.zz, sums.xy, out.data() + 4);
  Sum::total4(sums.yz, sums.zx, sums.size, sums.size_squares, out.data() + 8);
}

#ifdef TUMBLE_MOMENTS_AVX2
__attribute__((target("avx2"))) void add_block_avx2(const Vec3* vertices, const Triangle* triangles,
                                                    const Vec3& origin, BlockSums& out) {
  add_block<4, FourSum>(vertices, triangles, origin, out);
}
/// Four lanes as well, but with twice the registers.
__attribute__((target("avx2,avx512f,avx512vl,avx512dq"))) void add_block_avx512vl(
    const Vec3* vertices, const Triangle* triangles, const Vec3& origin, BlockSums& out) {
  add_block<4, FourSum>(vertices, triangles, origin, out);
}
#endif

}  // namespace

void add_block_baseline(const Vec3* vertices, const Triangle* triangles, const Vec3& origin,
                        BlockSums& out) {
  add_block<2, PairSum>(vertices, triangles, origin, out);
}

AddBlock fastest_add_block() {
#ifdef TUMBLE_MOMENTS_AVX2
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) {
    return add_block_avx512vl;
  }
  if (__builtin_cpu_supports("avx2")) return add_block_avx2;
#endif
  return add_block_baseline;
}

}  // namespace tumble
