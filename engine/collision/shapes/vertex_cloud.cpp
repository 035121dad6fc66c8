#include "engine/collision/shapes/vertex_cloud.hpp"

#include "engine/collision/shapes/vertex_scan.hpp"

#include <algorithm>

namespace tumble {

namespace {

#if defined(__x86_64__)
const auto scan_fast = __builtin_cpu_supports("avx") ? ScanByFour::many : ScanByTwo::many;
#else
const auto scan_fast = ScanByTwo::many;
#endif

}  // namespace

uint32_t scan_many_vertices(const VertexCloudView& v, const Plain3& d) {
  return scan_fast(v, d);
}

VertexCloud::VertexCloud(std::span<const Vec3> vertices) {
  const auto count = uint32_t(vertices.size());
  const uint32_t multiple = count <= few_vertices ? 4 : scan_block;
  padded_ = (count + multiple - 1) / multiple * multiple;
  coordinates_.resize(3 * padded_);
  for (uint32_t i = 0; i < padded_; ++i) {
    const Vec3& v = vertices[std::min(size_t(i), vertices.size() - 1)];
    for (uint32_t k = 0; k < 3; ++k) coordinates_[k * padded_ + i] = v[int(k)];
  }
  if (count > scan_limit) table_.emplace(vertices);
}

VertexCloudView VertexCloud::view() const {
  const double* x = coordinates_.data();
  return {x, x + padded_, x + 2 * padded_, padded_, table_ ? &*table_ : nullptr};
}

uint32_t VertexCloud::furthest(const Vec3& d) const {
  return furthest_vertex(view(), Plain3::of(d));
}

}  // namespace tumble
