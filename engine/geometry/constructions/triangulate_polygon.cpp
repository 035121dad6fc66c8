#include "engine/geometry/constructions/triangulate_polygon.hpp"

#include "engine/geometry/predicates/orientation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr size_t most_for_clipping = 10'000;
/// Up to this many corners the best ear is chosen, with more the first one found.
constexpr size_t most_for_quality = 32;

/// Projection of the polygon to the coordinate plane to which it is most nearly parallel,
/// counter-clockwise there.
std::vector<Vec2> shadow(std::span<const Vec3> vertices, std::span<const uint32_t> corners) {
  const Vec3& origin = vertices[corners[0]];
  Vec3 n = Vec3::Zero();
  for (size_t k = 1; k + 1 < corners.size(); ++k) {
    n += (vertices[corners[k]] - origin).cross(vertices[corners[k + 1]] - origin);
  }
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  const double sign = n[axis] < 0 ? -1 : 1;
  std::vector<Vec2> out;
  out.reserve(corners.size());
  for (uint32_t c : corners) {
    const Vec3& p = vertices[c];
    out.emplace_back(p[(axis + 1) % 3], sign * p[(axis + 2) % 3]);
  }
  return out;
}

struct Clipper {
  std::vector<Vec2> p;
  std::vector<uint32_t> ring;  // indices into p of the remaining corners

  bool holds(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& q) const {
    if (q == a || q == b || q == c) return false;
    return orientation(a, b, q) >= 0 && orientation(b, c, q) >= 0 && orientation(c, a, q) >= 0;
  }

  /// Quality of the ear at index k of the ring: 0 degenerate, 1 best; negative if it is not an ear.
  double ear(size_t k) const {
    const size_t n = ring.size();
    const Vec2 &a = p[ring[(k + n - 1) % n]], &b = p[ring[k]], &c = p[ring[(k + 1) % n]];
    if (orientation(a, b, c) <= 0) return -1;
    for (size_t i = 2; i + 1 < n; ++i) {
      if (holds(a, b, c, p[ring[(k + i) % n]])) return -1;
    }
    const Vec2 u = b - a, v = c - a;
    const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
    return longest > 0 ? std::fabs(u.x() * v.y() - u.y() * v.x()) / longest : 0;
  }

  size_t next_ear() const {
    size_t best = 0;
    double quality = -1;
    for (size_t k = 0; k < ring.size(); ++k) {
      const double q = ear(k);
      if (q <= quality) continue;
      quality = q;
      best = k;
      if (ring.size() > most_for_quality) break;
    }
    return best;
  }
};

}  // namespace

void triangulate_polygon(std::span<const Vec3> vertices, std::span<const uint32_t> corners,
                         std::vector<Triangle>& out) {
  const size_t n = corners.size();
  if (n < 3) return;
  if (n == 3 || n > most_for_clipping) {
    for (size_t k = 1; k + 1 < n; ++k) out.push_back({corners[0], corners[k], corners[k + 1]});
    return;
  }
  Clipper clipper{shadow(vertices, corners), {}};
  for (uint32_t k = 0; k < n; ++k) clipper.ring.push_back(k);
  while (clipper.ring.size() > 3) {
    const size_t k = clipper.next_ear(), m = clipper.ring.size();
    out.push_back({corners[clipper.ring[(k + m - 1) % m]], corners[clipper.ring[k]],
                   corners[clipper.ring[(k + 1) % m]]});
    clipper.ring.erase(clipper.ring.begin() + std::ptrdiff_t(k));
  }
  out.push_back({corners[clipper.ring[0]], corners[clipper.ring[1]], corners[clipper.ring[2]]});
}

}  // namespace tumble
