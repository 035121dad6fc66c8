#include "engine/geometry/continuous_tests/triangle_triangle.hpp"

#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/continuous_tests/edge_edge.hpp"
#include "engine/geometry/continuous_tests/exact_ends.hpp"
#include "engine/geometry/continuous_tests/moving_input.hpp"
#include "engine/geometry/continuous_tests/vertex_face.hpp"
#include "engine/geometry/primitive_tests/triangle_pairs.hpp"

#include <algorithm>

namespace tumble {
namespace {

using Pointers = std::array<const MovingPoint*, 3>;

Triangle3 start_corners(const MovingTriangle& t) {
  return {t[0].start, t[1].start, t[2].start};
}

/// Whether `direction` separates the two by more than `separation` throughout, rounding included.
bool separates_throughout(const Vec3& direction, const MovingTriangle& a, const MovingTriangle& b,
                          double separation) {
  const double length = direction.norm();
  if (!(length > 1e-100 && length < 1e100)) return false;
  const Vec3& origin = b[0].start;
  double size = 0, gap[2][2];
  int end = 0;
  for (const auto at : {&MovingPoint::start, &MovingPoint::end}) {
    double low[2], high[2];
    int which = 0;
    for (const MovingTriangle* t : {&a, &b}) {
      double d[3];
      for (size_t i = 0; i < 3; ++i) {
        const Vec3 from = (*t)[i].*at - origin;
        size = std::max(size, from.cwiseAbs().maxCoeff());
        d[i] = direction.dot(from);
      }
      low[which] = std::min({d[0], d[1], d[2]});
      high[which] = std::max({d[0], d[1], d[2]});
      ++which;
    }
    gap[end][0] = low[0] - high[1];
    gap[end][1] = low[1] - high[0];
    ++end;
  }
  const double needed = length * (separation * (1 + 0x1p-48) + 32 * 0x1p-53 * size);
  return std::max(std::min(gap[0][0], gap[1][0]), std::min(gap[0][1], gap[1][1])) > needed;
}

/// Tests the normals of the faces, for distant pairs that the coordinate axes do not separate.
bool apart_along_normals(const MovingTriangle& a, const MovingTriangle& b, double separation) {
  for (const MovingTriangle* t : {&a, &b}) {
    const MovingTriangle& c = *t;
    const Vec3 n = (c[1].start - c[0].start).cross(c[2].start - c[0].start);
    if (separates_throughout(n, a, b, separation)) return true;
  }
  return false;
}

/// Overlap at t = 0 that no pair of features may show. Exact if magnitudes allow; otherwise
/// anything within 1e-12 of the size counts as an overlap that is not certain.
std::optional<MovingTriangleContact> overlap_at_start(const MovingTriangle& a,
                                                      const MovingTriangle& b, double largest,
                                                      bool exact) {
  Triangle3 at = start_corners(a), bt = start_corners(b);
  MovingTriangleContact out;
  if (exact) {
    const auto hit = triangle_triangle_contact(at, bt);
    if (!hit) return std::nullopt;
    out.normal = hit->normal;
    out.t_hi = 0;
    out.certain = true;
    return out;
  }
  if (largest > 0) {
    const double factor = std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000));
    for (size_t i = 0; i < 3; ++i) {
      at[i] *= factor;
      bt[i] *= factor;
    }
  }
  const TrianglePair near = closest_triangle_triangle(at, bt);
  double size = 0;
  for (const Vec3& p : at) {
    for (const Vec3& q : bt) size = std::max(size, (p - q).squaredNorm());
  }
  if (!(near.squared_distance <= 1e-24 * size)) return std::nullopt;
  return out;
}

/// Keeps the earliest contact; a certain one bounds the end of every bracket.
class Earliest {
 public:
  void offer(const std::optional<MovingContact>& c, MovingFeatures features, size_t a, size_t b) {
    if (!c) return;
    if (c->certain) certain_by_ = std::min(certain_by_, c->t_hi);
    if (best_ && !(c->t_lo < best_->t_lo)) return;
    best_.emplace();
    static_cast<MovingContact&>(*best_) = *c;
    best_->features = features;
    best_->a = uint8_t(a);
    best_->b = uint8_t(b);
  }
  std::optional<MovingTriangleContact> get() const {
    std::optional<MovingTriangleContact> out = best_;
    if (out && certain_by_ <= out->t_hi) {
      out->t_hi = certain_by_;
      out->certain = true;
    }
    return out;
  }

 private:
  std::optional<MovingTriangleContact> best_;
  double certain_by_ = 2;
};

}  // namespace

Result<std::optional<MovingTriangleContact>> moving_triangles_contact(const MovingTriangle& a,
                                                                      const MovingTriangle& b,
                                                                      double separation) {
  if (!(separation >= 0)) return bad_separation("moving_triangles_contact", separation);
  const Pointers of_a{&a[0], &a[1], &a[2]}, of_b{&b[0], &b[1], &b[2]};
  const std::array points{of_a[0], of_a[1], of_a[2], of_b[0], of_b[1], of_b[2]};
  const double largest = largest_magnitude(points);
  if (!(largest <= largest_direct)) {
    if (!std::isfinite(largest)) return not_finite("moving_triangles_contact");
    constexpr double down = 0x1p-40;
    return moving_triangles_contact({scaled(a[0], down), scaled(a[1], down), scaled(a[2], down)},
                                    {scaled(b[0], down), scaled(b[1], down), scaled(b[2], down)},
                                    separation * down);
  }
  std::optional<MovingTriangleContact> none;
  if (apart_along_axes(of_a, of_b, separation)) return none;
  if (apart_along_normals(a, b, separation)) return none;
  if (const auto overlap = overlap_at_start(a, b, largest, within_exact_range(points))) {
    return overlap;
  }
  Earliest earliest;
  for (size_t i = 0; i < 3; ++i) {
    const auto on_b = vertex_face_contact(a[i], b, separation);
    if (!on_b) return on_b.error();
    earliest.offer(*on_b, MovingFeatures::vertex_face, i, 0);
    auto on_a = vertex_face_contact(b[i], a, separation);
    if (!on_a) return on_a.error();
    if (*on_a) (*on_a)->normal = -(*on_a)->normal;
    earliest.offer(*on_a, MovingFeatures::face_vertex, 0, i);
    for (size_t j = 0; j < 3; ++j) {
      const auto edges =
          edge_edge_contact({a[i], a[(i + 1) % 3]}, {b[j], b[(j + 1) % 3]}, separation);
      if (!edges) return edges.error();
      earliest.offer(*edges, MovingFeatures::edge_edge, i, j);
    }
  }
  return earliest.get();
}

}  // namespace tumble
