#include "engine/collision/shapes/vertex_cloud.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Vectors of the given number of doubles, addressed anywhere.
template <size_t lanes>
struct Wide;
template <>
struct Wide<2> {
  typedef double Doubles __attribute__((vector_size(16)));
  typedef double Anywhere __attribute__((vector_size(16), aligned(8), may_alias));
};
template <>
struct Wide<4> {
  typedef double Doubles __attribute__((vector_size(32)));
  typedef double Anywhere __attribute__((vector_size(32), aligned(8), may_alias));
};

/// Heights go to a buffer while the greatest is sought; the first that equals it is then looked up.
/// The operations on each vertex are the same for any number of lanes.
template <size_t lanes>
__attribute__((always_inline)) inline uint32_t scan_by(const VertexCloudView& v, const Plain3& d) {
  using Doubles = typename Wide<lanes>::Doubles;
  using Anywhere = typename Wide<lanes>::Anywhere;
  constexpr uint32_t block = 128;
  alignas(32) double heights[block];
  const Doubles zero{}, x = d.x - zero, y = d.y - zero, z = d.z - zero;
  uint32_t best = 0;
  double height = -std::numeric_limits<double>::infinity();
  for (uint32_t begin = 0; begin < v.padded; begin += block) {
    const uint32_t count = std::min(block, v.padded - begin);
    Doubles m = -std::numeric_limits<double>::infinity() - zero;
    for (uint32_t i = 0; i < count; i += lanes) {
      const Doubles vx = *reinterpret_cast<const Anywhere*>(v.x + begin + i),
                    vy = *reinterpret_cast<const Anywhere*>(v.y + begin + i),
                    vz = *reinterpret_cast<const Anywhere*>(v.z + begin + i),
                    h = (vx * x + vy * y) + vz * z;
      *reinterpret_cast<Doubles*>(heights + i) = h;
      m = m > h ? m : h;
    }
    double most = m[0];
    for (size_t k = 1; k < lanes; ++k) most = m[k] > most ? m[k] : most;
    if (!(most > height)) continue;
    height = most;
    const __m128d both = _mm_set1_pd(most);
    for (uint32_t i = 0; i < count; i += 4) {
      const int bits = _mm_movemask_pd(_mm_cmpeq_pd(_mm_load_pd(heights + i), both)) |
                       _mm_movemask_pd(_mm_cmpeq_pd(_mm_load_pd(heights + i + 2), both)) << 2;
      if (!bits) continue;
      best = begin + i + uint32_t(__builtin_ctz(unsigned(bits)));
      break;
    }
  }
  return best;
}

uint32_t scan_by_two(const VertexCloudView& v, const Plain3& d) {
  return scan_by<2>(v, d);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) uint32_t scan_by_four(const VertexCloudView& v, const Plain3& d) {
  return scan_by<4>(v, d);
}
const auto scan_fast = __builtin_cpu_supports("avx2") ? scan_by_four : scan_by_two;
#else
const auto scan_fast = scan_by_two;
#endif

}  // namespace

uint32_t scan_many_vertices(const VertexCloudView& v, const Plain3& d) {
  return scan_fast(v, d);
}

VertexClimber::VertexClimber(const ConvexPolyhedron& polyhedron)
    : neighbour_first_(polyhedron.neighbour_first), neighbours_(polyhedron.neighbours) {
  constexpr uint32_t n = cells_per_side;
  for (const Vec3& v : polyhedron.vertices) vertices_.push_back(Plain3::of(v));
  uint32_t last = 0;
  for (uint32_t k = 0; k < start_.size(); ++k) {
    const uint32_t side = k / (n * n), axis = side / 2;
    const double u = (2.0 * (k / n % n) + 1) / n - 1, w = (2.0 * (k % n) + 1) / n - 1;
    Vec3 d;
    d[int(axis)] = side % 2 ? -1 : 1;
    d[int((axis + 1) % 3)] = u;
    d[int((axis + 2) % 3)] = w;
    start_[k] = last = climb(Plain3::of(d), last);
  }
}

uint32_t VertexClimber::cell(const Plain3& d) {
  const std::array<double, 3> p{d.x, d.y, d.z};
  const double sx = std::abs(d.x), sy = std::abs(d.y), sz = std::abs(d.z);
  const size_t axis = sx >= sy ? (sx >= sz ? 0 : 2) : (sy >= sz ? 1 : 2);
  const double most = std::max(sx, std::max(sy, sz));
  constexpr double half = cells_per_side / 2.0;
  const double scale = most > 0 ? half / most : 0;
  const auto place = [&](double x) {
    const double at = x * scale + half;
    return at >= 0 ? std::min(uint32_t(at), cells_per_side - 1) : 0;
  };
  const uint32_t side = 2 * uint32_t(axis) + (p[axis] < 0);
  return (side * cells_per_side + place(p[(axis + 1) % 3])) * cells_per_side +
         place(p[(axis + 2) % 3]);
}

uint32_t VertexClimber::climb(const Plain3& d, uint32_t from) const {
  uint32_t best = from;
  double height = d.dot(vertices_[best]);
  for (uint32_t at = best + 1; at != best;) {
    at = best;
    for (uint32_t k = neighbour_first_[at]; k < neighbour_first_[at + 1]; ++k) {
      const uint32_t v = neighbours_[k];
      const double h = d.dot(vertices_[v]);
      if (h > height) height = h, best = v;
    }
  }
  return best;
}

uint32_t VertexClimber::settle(const Plain3& d, uint32_t from, double reach) const {
  constexpr size_t most = 24;
  std::array<uint32_t, most> level;  // vertices that rounding cannot tell from the highest
  size_t count = 1;
  level[0] = from;
  uint32_t best = from;
  double height = d.dot(vertices_[from]);
  const double slack = 2e-15 * reach * std::sqrt(d.squared());
  for (size_t i = 0; i < count; ++i) {
    for (uint32_t k = neighbour_first_[level[i]]; k < neighbour_first_[level[i] + 1]; ++k) {
      const uint32_t v = neighbours_[k];
      const double h = d.dot(vertices_[v]);
      if (h < height - slack) continue;
      if (std::find(level.begin(), level.begin() + count, v) != level.begin() + count) continue;
      if (h > height) height = h, best = v;
      if (count == most) return unsure;
      level[count++] = v;
    }
  }
  return best;
}

uint32_t VertexClimber::climb_from_nearer(const Plain3& d, uint32_t from) const {
  const uint32_t start = start_[cell(d)];
  return climb(d, d.dot(vertices_[start]) > d.dot(vertices_[from]) ? start : from);
}

bool VertexClimber::suits(const ConvexPolyhedron& p) {
  double reach = 0, flatness = 0;
  for (const Vec3& v : p.vertices) reach = std::max(reach, v.norm());
  for (size_t f = 0; f < p.face_count(); ++f)
    for (uint32_t v : p.face(f))
      flatness = std::max(flatness, std::abs(p.planes[f].distance(p.vertices[v])));
  return flatness <= 1e-14 * reach;
}

VertexCloud::VertexCloud(const ConvexPolyhedron& polyhedron) {
  const auto& vertices = polyhedron.vertices;
  padded_ = (uint32_t(vertices.size()) + 3) / 4 * 4;
  coordinates_.resize(3 * padded_);
  for (uint32_t i = 0; i < padded_; ++i) {
    const Vec3& v = vertices[std::min(size_t(i), vertices.size() - 1)];
    for (uint32_t k = 0; k < 3; ++k) coordinates_[k * padded_ + i] = v[int(k)];
  }
  if (vertices.size() > vertex_scan_limit && VertexClimber::suits(polyhedron))
    climber_.emplace_back(polyhedron);
}

VertexCloudView VertexCloud::view() const {
  const double* x = coordinates_.data();
  return {x, x + padded_, x + 2 * padded_, padded_, climber_.empty() ? nullptr : climber_.data()};
}

uint32_t VertexCloud::furthest(const Vec3& d) const {
  const Plain3 p = Plain3::of(d);
  return climber_.empty() ? scan_vertices(view(), p) : climber_[0].climb(p);
}

}  // namespace tumble
