#include "engine/collision/mesh_pairs/small_surface.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include <emmintrin.h>

namespace tumble {
namespace {

/// Distance from a plane of three points with these heights over it; negative if they are on both
/// sides.
double beyond(double x, double y, double z) {
  return std::max(std::min(x, std::min(y, z)), -std::max(x, std::max(y, z)));
}

uint64_t first_bits(size_t n) {
  return n < 64 ? (uint64_t{1} << n) - 1 : ~uint64_t{0};
}

template <class T>
std::vector<T>& memory() {
  static thread_local std::vector<T> items;
  return items;
}

}  // namespace

SmallSurface::SmallSurface(const PlacedSurface& small, const PlacedSurface& large, bool is_a,
                           NearPairs& pairs)
    : small_(small),
      large_(large),
      R_(large.R.transpose() * small.R),
      corners_(memory<Vec3>()),
      by_two_(memory<TwoCorners>()),
      heights_(memory<double>()),
      facets_at_(memory<uint64_t>()),
      facets_(memory<Facet>()),
      is_a_(is_a),
      pairs_(pairs) {
  const Vec3 x = large.R.transpose() * (small.x - large.x);
  const std::vector<Vec3>& vertices = small.s.mesh->vertices;
  const size_t twos = (vertices.size() + 1) / 2;
  corners_.resize(vertices.size());
  by_two_.resize(twos);
  heights_.resize(2 * twos);
  facets_at_.clear();
  facets_.resize(small.s.mesh->triangles.size());
  for (size_t i = 0; i < corners_.size(); ++i) {
    corners_[i] = R_ * vertices[i] + x;
    if (i == 0) box_ = {corners_[i], corners_[i]};
    box_ = {box_.min.cwiseMin(corners_[i]), box_.max.cwiseMax(corners_[i])};
  }
  for (size_t i = 0; i < twos; ++i) {
    const Vec3 &p = corners_[2 * i], &q = corners_[std::min(2 * i + 1, corners_.size() - 1)];
    by_two_[i] = {{p.x(), q.x()}, {p.y(), q.y()}, {p.z(), q.z()}};
  }
}

const SmallSurface::Facet& SmallSurface::facet(uint32_t i) {
  Facet& f = facets_[i];
  if (asked_ >> i & 1) return f;
  asked_ |= uint64_t{1} << i;
  const Triangle& ids = small_.s.mesh->triangles[i];
  const Vec3 &p = corners_[ids[0]], &q = corners_[ids[1]], &r = corners_[ids[2]];
  f.box = {p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r)};
  f.normal = R_ * small_.s.topology.face_normals[i];
  f.offset = f.normal.dot(p);
  return f;
}

double SmallSurface::distance(uint32_t i, const Met& triangle) {
  const Facet& f = facet(i);
  const double between = gap_between(triangle.box, f.box);
  if (between > pairs_.reach) return between;
  const auto height = [&](size_t k) { return f.normal.dot(triangle.corners[k]) - f.offset; };
  return std::max(between, beyond(height(0), height(1), height(2)));
}

double SmallSurface::raise(const Vec3& normal, double offset, Beyond& beyond) {
  const __m128d nx = _mm_set1_pd(normal.x()), ny = _mm_set1_pd(normal.y()),
                nz = _mm_set1_pd(normal.z()), down = _mm_set1_pd(offset),
                reach = _mm_set1_pd(pairs_.reach), minus_reach = _mm_set1_pd(-pairs_.reach);
  __m128d low = _mm_set1_pd(std::numeric_limits<double>::infinity());
  __m128d high = _mm_set1_pd(-std::numeric_limits<double>::infinity());
  const size_t twos = heights_.size() / 2;
  for (size_t i = 0; i < twos; ++i) {
    const TwoCorners& p = by_two_[i];
    const __m128d x = _mm_mul_pd(nx, _mm_loadu_pd(p.x.data())),
                  y = _mm_mul_pd(ny, _mm_loadu_pd(p.y.data())),
                  z = _mm_mul_pd(nz, _mm_loadu_pd(p.z.data()));
    const __m128d sum = _mm_add_pd(x, _mm_add_pd(y, z));  // in the order of Vec3::dot
    const __m128d h = _mm_sub_pd(sum, down);
    _mm_storeu_pd(&heights_[2 * i], h);
    low = _mm_min_pd(low, h);
    high = _mm_max_pd(high, h);
    beyond.above |= uint64_t(_mm_movemask_pd(_mm_cmpgt_pd(h, reach))) << (2 * i);
    beyond.below |= uint64_t(_mm_movemask_pd(_mm_cmplt_pd(h, minus_reach))) << (2 * i);
  }
  low = _mm_min_pd(low, _mm_unpackhi_pd(low, low));
  high = _mm_max_pd(high, _mm_unpackhi_pd(high, high));
  return std::max(_mm_cvtsd_f64(low), -_mm_cvtsd_f64(high));
}

double SmallSurface::over_plane(uint32_t facet) const {
  const Triangle& f = small_.s.mesh->triangles[facet];
  return beyond(heights_[f[0]], heights_[f[1]], heights_[f[2]]);
}

void SmallSurface::note_facets_left_out() {
  for (uint32_t i = 0; i < facets_.size(); ++i) (void)pairs_.apart(over_plane(i));
}

uint64_t SmallSurface::facets_with_others(uint64_t corners) const {
  uint64_t facets = 0;
  for (uint64_t rest = ~corners & first_bits(corners_.size()); rest != 0; rest &= rest - 1)
    facets |= facets_at_[size_t(std::countr_zero(rest))];
  return facets;
}

void SmallSurface::meet_facets(const Met& triangle, const Beyond& beyond) {
  if (facets_at_.empty()) {
    facets_at_.assign(corners_.size(), 0);
    for (size_t i = 0; i < facets_.size(); ++i)
      for (const uint32_t corner : small_.s.mesh->triangles[i])
        facets_at_[corner] |= uint64_t{1} << i;
  }
  uint64_t near = first_bits(facets_.size());
  if (beyond.above != 0) near &= facets_with_others(beyond.above);
  if (beyond.below != 0) near &= facets_with_others(beyond.below);
  for (; near != 0; near &= near - 1) {
    const auto i = uint32_t(std::countr_zero(near));
    const double away = std::max(over_plane(i), distance(i, triangle));
    if (pairs_.apart(away)) continue;
    pairs_.add(is_a_ ? TriangleIds{i, triangle.id} : TriangleIds{triangle.id, i}, away);
  }
}

void SmallSurface::meet(uint32_t triangle) {
  const TriangleMesh& mesh = *large_.s.mesh;
  Met met{
      triangle, {mesh.corner(triangle, 0), mesh.corner(triangle, 1), mesh.corner(triangle, 2)}, {}};
  const auto& p = met.corners;
  met.box = {p[0].cwiseMin(p[1]).cwiseMin(p[2]), p[0].cwiseMax(p[1]).cwiseMax(p[2])};
  if (pairs_.apart(gap_between(met.box, box_))) return;
  const Vec3 normal = large_.s.topology.face_normals[triangle];
  Beyond beyond;
  if (pairs_.apart(raise(normal, normal.dot(p[0]), beyond))) return;
  meet_facets(met, beyond);
  // The distance of the other pairs only matters if there is no pair within reach.
  if (pairs_.within.empty()) note_facets_left_out();
}

void SmallSurface::run(size_t most) {
  const AabbTree& tree = *large_.s.tree;
  const Vec3 origin = tree.origin();
  const Aabb box{box_.min - origin, box_.max - origin};
  const double rounding = 1e-6 * (small_.s.size + large_.s.size);  // of the tree's boxes
  thread_local std::vector<uint32_t> stack, triangles;
  stack.assign(1, 0);
  triangles.clear();
  while (!stack.empty()) {
    const uint32_t at = stack.back();
    stack.pop_back();
    const AabbTree::Node& node = tree.nodes()[at];
    const Aabb bounds{Vec3(node.min[0], node.min[1], node.min[2]),
                      Vec3(node.max[0], node.max[1], node.max[2])};
    if (pairs_.apart(gap_between(bounds, box) - rounding)) continue;
    if (!node.is_leaf()) {
      stack.push_back(node.start);
      stack.push_back(at + 1);
      continue;
    }
    for (uint32_t i = 0; i < node.count; ++i)
      triangles.push_back(tree.triangle_order()[node.start + i]);
  }
  std::ranges::sort(triangles);  // so that the pairs come in order
  for (size_t i = 0; i < triangles.size() && pairs_.within.size() <= most; ++i) meet(triangles[i]);
}

}  // namespace tumble
