#include "engine/geometry/hierarchy/node_bound.hpp"

#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

using std::numbers::pi;

/// Convex hull of coplanar points, counter-clockwise about the normal, by Andrew's monotone chain
/// (1979). Two points if they are collinear, one if they are equal.
struct FlatHull {
  Vec3 normal = Vec3::UnitZ();
  std::vector<Vec3> loop;
};

Vec3 flat_normal(std::span<const Vec3> points) {
  // The largest triangle on the longest segment from the first point: enough to find the plane.
  const auto far = [&](const Vec3& from) {
    return *std::max_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
      return (a - from).squaredNorm() < (b - from).squaredNorm();
    });
  };
  const Vec3 a = far(points[0]), ab = far(a) - a;
  Vec3 best = Vec3::Zero();
  for (const Vec3& p : points) {
    const Vec3 n = ab.cross(p - a);
    if (n.squaredNorm() > best.squaredNorm()) best = n;
  }
  const double size = ab.norm();
  if (best.norm() > 1e-12 * size * size) return best.normalized();
  if (!(size > 0)) return Vec3::UnitZ();
  Vec3 u, v;
  tangent_frame(ab / size, u, v);
  return u;
}

FlatHull flat_hull(std::span<const Vec3> points) {
  FlatHull out;
  out.normal = flat_normal(points);
  Vec3 u, v;
  tangent_frame(out.normal, u, v);
  if (u.cross(v).dot(out.normal) < 0) std::swap(u, v);
  struct Placed {
    double x, y;
    const Vec3* p;
  };
  std::vector<Placed> sorted;
  for (const Vec3& p : points) sorted.push_back({u.dot(p - points[0]), v.dot(p - points[0]), &p});
  std::sort(sorted.begin(), sorted.end(),
            [](const Placed& a, const Placed& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const auto same = [](const Placed& a, const Placed& b) { return a.x == b.x && a.y == b.y; };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  std::vector<Placed> loop;
  const auto chain = [&](auto begin, auto end) {
    const size_t before = loop.size();
    for (auto it = begin; it != end; ++it) {
      const auto turns_left = [&] {
        const Placed &a = loop[loop.size() - 2], &b = loop.back();
        return (b.x - a.x) * (it->y - a.y) - (b.y - a.y) * (it->x - a.x) > 0;
      };
      while (loop.size() >= before + 2 && !turns_left()) loop.pop_back();
      loop.push_back(*it);
    }
    loop.pop_back();  // it begins the other chain
  };
  chain(sorted.begin(), sorted.end());
  chain(sorted.rbegin(), sorted.rend());
  if (loop.empty()) loop.push_back(sorted.front());
  for (const Placed& p : loop) out.loop.push_back(*p.p);
  return out;
}

ConvexMeasure flat_measure(std::span<const Vec3> points) {
  const FlatHull flat = flat_hull(points);
  const size_t n = flat.loop.size();
  Vec3 area = Vec3::Zero();
  double round = 0;
  for (size_t k = 0; k < n; ++k) {
    const Vec3 &a = flat.loop[k], &b = flat.loop[(k + 1) % n];
    area += 0.5 * (a - flat.loop[0]).cross(b - flat.loop[0]);
    round += (b - a).norm();
  }
  return {0, 2 * area.norm(), 0.5 * pi * round};
}

ConvexMeasure hull_measure(const ConvexPolyhedron& p) {
  ConvexMeasure out;
  const Vec3& origin = p.vertices[0];
  for (size_t f = 0; f < p.face_count(); ++f) {
    const auto loop = p.face(f);
    const Vec3& a = p.vertices[loop[0]];
    for (size_t k = 2; k < loop.size(); ++k) {
      const Vec3 n = (p.vertices[loop[k - 1]] - a).cross(p.vertices[loop[k]] - a);
      out.surface += 0.5 * n.norm();
      out.volume += n.dot(a - origin) / 6;
    }
  }
  for (const PolyhedronEdge& e : p.edges) {
    const Vec3 &n0 = p.planes[e.faces[0]].normal, &n1 = p.planes[e.faces[1]].normal;
    const double angle = det::atan2(n0.cross(n1).norm(), n0.dot(n1));
    out.curvature += 0.5 * angle * (p.vertices[e.vertices[1]] - p.vertices[e.vertices[0]]).norm();
  }
  return out;
}

struct BoundWires {
  const Pose& pose;
  const Vec4f& colour;
  DebugDraw& out;
  void line(const Vec3& a, const Vec3& b) const { out.line(pose.point(a), pose.point(b), colour); }
};

void sphere_wires(const Vec3& centre, double radius, const BoundWires& w) {
  constexpr int corners = 48;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](int k) {
      const double angle = 2 * pi * k / corners;
      Vec3 p = centre;
      p[(axis + 1) % 3] += radius * det::cos(angle);
      p[(axis + 2) % 3] += radius * det::sin(angle);
      return p;
    };
    for (int k = 0; k < corners; ++k) w.line(at(k), at(k + 1));
  }
}

void flat_wires(std::span<const Vec3> points, double radius, const BoundWires& w) {
  const FlatHull flat = flat_hull(points);
  const size_t n = flat.loop.size();
  if (n == 1) return sphere_wires(flat.loop[0], radius, w);
  const auto outwards = [&](size_t k) {  // outward normal of the side from corner k
    return (flat.loop[(k + 1) % n] - flat.loop[k % n]).cross(flat.normal).normalized();
  };
  const auto end = [&](size_t k) -> Vec3 {
    const Vec3 both = outwards(k + n - 1) + outwards(k);
    const Vec3 along = flat.loop[k % n] - flat.loop[(k + 1) % n];
    const bool tip = n == 2;  // the two sides of a segment, whose normals cancel
    return flat.loop[k % n] + radius * (tip ? along : both).normalized();
  };
  for (size_t k = 0; k < n; ++k)
    if (n > 2 || k == 0) w.line(end(k), end((k + 1) % n));
}

void hull_wires(const ConvexPolyhedron& p, double radius, const BoundWires& w) {
  std::vector<Vec3> ends = p.vertices;
  if (radius > 0) {
    std::vector<Vec3> normals(ends.size(), Vec3::Zero());
    for (size_t f = 0; f < p.face_count(); ++f)
      for (uint32_t v : p.face(f)) normals[v] += p.planes[f].normal;
    for (size_t v = 0; v < ends.size(); ++v) ends[v] += radius * normals[v].normalized();
  }
  for (const PolyhedronEdge& e : p.edges) w.line(ends[e.vertices[0]], ends[e.vertices[1]]);
}

}  // namespace

void set_box(NodeBound& out, const Vec3& centre, const Mat3& half_axes) {
  out.form = BoundForm::box;
  out.radius = 0;
  out.points.clear();
  for (int bits = 0; bits < 8; ++bits)
    out.points.push_back(centre +
                         half_axes * Vec3(bits & 1 ? 1 : -1, bits & 2 ? 1 : -1, bits & 4 ? 1 : -1));
}

ConvexMeasure measure(const NodeBound& bound) {
  const std::vector<Vec3>& p = bound.points;
  if (p.empty()) return {};
  ConvexMeasure m;
  if (bound.form == BoundForm::box) {
    const double a = (p[1] - p[0]).norm(), b = (p[2] - p[0]).norm(), c = (p[4] - p[0]).norm();
    m = {a * b * c, 2 * (a * b + b * c + c * a), pi * (a + b + c)};
  } else if (bound.form == BoundForm::hull) {
    const auto hull = convex_hull(p);
    m = hull ? hull_measure(hull->polyhedron) : flat_measure(p);
  }
  const double r = bound.radius;
  return {m.volume + r * (m.surface + r * (m.curvature + 4 * pi / 3 * r)),
          m.surface + r * (2 * m.curvature + 4 * pi * r), m.curvature + 4 * pi * r};
}

void draw_bound(const NodeBound& bound, const Pose& pose, const Vec4f& colour, DebugDraw& out) {
  if (bound.points.empty()) return;
  const BoundWires w{pose, colour, out};
  switch (bound.form) {
    case BoundForm::box:
      for (size_t bits = 0; bits < 8; ++bits)
        for (size_t axis = 1; axis < 8; axis *= 2)
          if (!(bits & axis)) w.line(bound.points[bits], bound.points[bits | axis]);
      return;
    case BoundForm::sphere:
      return sphere_wires(bound.points[0], bound.radius, w);
    case BoundForm::hull:
      if (const auto hull = convex_hull(bound.points)) {
        hull_wires(hull->polyhedron, bound.radius, w);
      } else {
        flat_wires(bound.points, bound.radius, w);
      }
      return;
  }
}

}  // namespace tumble
