#include "engine/geometry/mass_properties/moment_sums.hpp"

#include "engine/geometry/mass_properties/moment_blocks.hpp"
#include "engine/math/double_double.hpp"
#include "engine/math/triple.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Sums of blocks with compensation of the rounding of each addition.
struct CompensatedSums {
  BlockSums high{}, low{};

  void add(const BlockSums& x) {
    for (size_t k = 0; k < moment_sum_count; ++k) {
      double rest = 0;
      two_sum(high[k], x[k], high[k], rest);
      low[k] += rest;
    }
  }
};

CompensatedSums add_all(const TriangleMesh& mesh, const Vec3& origin, AddBlock add_block) {
  CompensatedSums out;
  BlockSums block;
  const Vec3* vertices = mesh.vertices.data();
  const size_t count = mesh.triangles.size(), whole = count / block_triangles * block_triangles;
  for (size_t t = 0; t < whole; t += block_triangles) {
    add_block(vertices, mesh.triangles.data() + t, origin, block);
    out.add(block);
  }
  if (whole == count) return out;
  // The last block is padded with triangles that are points, whose terms are zero.
  std::array<Triangle, block_triangles> rest;
  const uint32_t any = mesh.triangles[whole][0];
  rest.fill({any, any, any});
  std::copy(mesh.triangles.begin() + std::ptrdiff_t(whole), mesh.triangles.end(), rest.begin());
  add_block(vertices, rest.data(), origin, block);
  out.add(block);
  return out;
}

// -- the same in double-double arithmetic --------------------------------------------------------

using Precise = Triple<DoubleDouble>;

/// Indices of a symmetric matrix: xx, yy, zz, xy, yz, zx.
constexpr std::array<std::array<size_t, 2>, 6> entries{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}}};

}  // namespace

MomentSums sum_moments(const TriangleMesh& mesh, const Vec3& origin, bool narrow) {
  static const AddBlock fastest = fastest_add_block();
  const CompensatedSums total = add_all(mesh, origin, narrow ? add_block_baseline : fastest);
  BlockSums s;
  for (size_t k = 0; k < moment_sum_count; ++k) s[k] = total.high[k] + total.low[k];
  MomentSums out;
  out.volume6 = s[0];
  out.moment24 = {s[1], s[2], s[3]};
  for (size_t e = 0; e < 6; ++e) {
    const auto [i, j] = entries[e];
    out.second120(int(i), int(j)) = out.second120(int(j), int(i)) = s[4 + e];
  }
  out.size6 = s[10];
  out.size120 = s[11];
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
  // Each term has about eight roundings of 1.1e-16 of its size.
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
  Precise moment{};
  std::array<DoubleDouble, 6> second{};
  for (const Triangle& t : mesh.triangles) {
    const auto from_origin = [&](uint32_t v) {
      return Precise::of(mesh.vertices[v]) - Precise::of(origin);
    };
    const Precise a = from_origin(t[0]), b = from_origin(t[1]), c = from_origin(t[2]);
    const DoubleDouble d = a.dot((b - a).cross(c - a));
    const Precise s = a + b + c;
    volume6 = volume6 + d;
    moment = moment + s * d;
    for (size_t e = 0; e < 6; ++e) {
      const auto [i, j] = entries[e];
      second[e] = second[e] + d * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j]);
    }
  }
  SolidMoments out;
  out.volume = volume6.high / 6;
  out.centre = origin;
  if (volume6.high == 0) return out;
  const DoubleDouble fourfold = volume6 * DoubleDouble{4, 0};
  const Precise centre{moment.x / fourfold, moment.y / fourfold, moment.z / fourfold};
  const Precise moved_back = Precise::of(origin) + centre;
  out.centre = {moved_back.x.high, moved_back.y.high, moved_back.z.high};
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
