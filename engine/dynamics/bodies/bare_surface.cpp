#include "engine/dynamics/bodies/bare_surface.hpp"

#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/v_clip/voronoi_polyhedron.hpp"
#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/geometry/constructions/projections.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using Polygon = std::vector<Vec3>;

/// A direction in the half-plane through the y axis: components away from the axis and along it.
struct Latitude {
  double out = 0, up = 0;
};

/// Latitudes in even steps, and the normals of straight sides of the profile, perpendicular to the
/// chord between two different support points of the core.
std::vector<Latitude> latitudes(const ConvexShape& shape) {
  constexpr int steps = tolerances::bare_parallels;
  std::vector<Latitude> out;
  Vec3 before = Vec3::Zero();
  for (int k = 0; k <= steps; ++k) {
    const double angle = det::pi * (double(k) / steps - 0.5);
    const Latitude now = k == 0       ? Latitude{0, -1}
                         : k == steps ? Latitude{0, 1}
                                      : Latitude{det::cos(angle), det::sin(angle)};
    const Vec3 support = shape.support({now.out, now.up, 0});
    const double across = support.x() - before.x(), along = support.y() - before.y();
    const double length = std::sqrt(across * across + along * along);
    if (k > 0 && length > tolerances::inner_slit * shape.bounding_radius()) {
      const Latitude side{along / length, -across / length};
      const auto known = [&](const Latitude& l) {
        return l.out * side.out + l.up * side.up > 1 - tolerances::bare_same_way;
      };
      if (!known(out.back()) && !known(now)) out.push_back(side);
    }
    out.push_back(now);
    before = support;
  }
  return out;
}

/// Planes that bound a convex shape, in its frame: its faces, or tangent planes all around.
std::vector<Plane> planes_of(const ConvexShape& shape) {
  std::vector<Plane> out;
  if (const VoronoiPolyhedron* solid = shape.voronoi()) {
    for (const VoronoiFace& f : solid->faces) out.push_back({f.normal, f.offset});
    return out;
  }
  const auto add = [&](const Vec3& n) {
    out.push_back({n, n.dot(shape.support(n)) + shape.rounding()});
  };
  for (const Latitude& l : latitudes(shape)) {
    if (l.out == 0) {
      add({0, l.up, 0});
      continue;
    }
    for (int k = 0; k < tolerances::bare_meridians; ++k) {
      const double turn = 2 * det::pi * k / tolerances::bare_meridians;
      add({l.out * det::cos(turn), l.up, l.out * det::sin(turn)});
    }
  }
  return out;
}

/// The parts of a convex polygon on either side of a plane; a part without area is empty.
struct Split {
  Polygon in, out;
};
Split split(const Polygon& polygon, const Vec3& normal, double offset, double rounding) {
  Split parts;
  bool any_in = false, any_out = false;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = normal.dot(a) - offset, db = normal.dot(b) - offset;
    any_in |= da < -rounding;
    any_out |= da > rounding;
    if (da <= rounding) parts.in.push_back(a);
    if (da >= -rounding) parts.out.push_back(a);
    if ((da < -rounding && db > rounding) || (da > rounding && db < -rounding)) {
      const Vec3 between = a + da / (da - db) * (b - a);
      parts.in.push_back(between);
      parts.out.push_back(between);
    }
  }
  if (!any_in && any_out) parts.in.clear();
  if (!any_out) parts.out.clear();
  return parts;
}

/// A bounding ball, by which distant pairs are skipped.
struct Reach {
  Vec3 middle = Vec3::Zero();
  double radius = 0;
  bool meets(const Reach& other, double slit) const {
    const double r = radius + other.radius + slit;
    return (middle - other.middle).squaredNorm() <= r * r;
  }
};

Reach reach_of(const Polygon& polygon) {
  Reach out;
  for (const Vec3& p : polygon) out.middle += p / double(polygon.size());
  for (const Vec3& p : polygon) out.radius = std::max(out.radius, (p - out.middle).norm());
  return out;
}

struct Solid {
  std::vector<Plane> planes;  ///< in the body's frame
  Reach reach;
};

Solid placed(const BodyShape& s) {
  Solid out{planes_of(*s.shape->convex()), {s.pose.x, s.shape->bounding_radius()}};
  for (Plane& p : out.planes) {
    p.normal = s.pose.direction(p.normal);
    p.offset += p.normal.dot(s.pose.x);
  }
  return out;
}

Polygon face_of(const Solid& solid, const Plane& plane, double rounding) {
  const Vec3 u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
  const Vec3 middle = solid.reach.middle - plane.distance(solid.reach.middle) * plane.normal;
  const double r = 2 * solid.reach.radius;
  Polygon out{middle + r * u, middle + r * v, middle - r * u, middle - r * v};
  for (const Plane& p : solid.planes)
    if (&p != &plane && out.size() > 2) out = split(out, p.normal, p.offset, rounding).in;
  return out;
}

/// Removes from the pieces of a face with this normal what a solid covers. The solid is inflated by
/// `slit` on all sides, and tested twice that in front of the face, so that flush faces remain.
void take_out(const Solid& solid, const Vec3& normal, double slit, double rounding,
              std::vector<Polygon>& pieces) {
  std::vector<Polygon> left;
  for (Polygon& piece : pieces) {
    if (!reach_of(piece).meets(solid.reach, 4 * slit)) {
      left.push_back(std::move(piece));
      continue;
    }
    std::vector<Polygon> bare;
    Polygon rest = piece;
    for (const Plane& p : solid.planes) {
      const double offset = p.offset + slit - 2 * slit * p.normal.dot(normal);
      Split parts = split(rest, p.normal, offset, rounding);
      rest = std::move(parts.in);
      if (parts.out.size() > 2) bare.push_back(std::move(parts.out));
      if (rest.size() < 3) break;
    }
    if (rest.size() < 3) {
      left.push_back(std::move(piece));
    } else {
      for (Polygon& b : bare) left.push_back(std::move(b));
    }
  }
  pieces = std::move(left);
}

void append(TriangleMesh& mesh, const Polygon& polygon, double rounding) {
  const uint32_t first = uint32_t(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), polygon.begin(), polygon.end());
  for (size_t k = 1; k + 1 < polygon.size(); ++k) {
    const double area = (polygon[k] - polygon[0]).cross(polygon[k + 1] - polygon[0]).squaredNorm();
    if (area > rounding * rounding * rounding * rounding)
      mesh.triangles.push_back({first, first + uint32_t(k), first + uint32_t(k) + 1});
  }
}

}  // namespace

BareSurface::BareSurface(std::span<const BodyShape> shapes) {
  std::vector<Solid> solids;
  for (const BodyShape& s : shapes) {
    if (!s.shape->convex()) continue;
    size_ = std::max(size_, s.pose.x.norm() + s.shape->bounding_radius());
    solids.push_back(placed(s));
  }
  const double slit = tolerances::inner_slit * size_, rounding = tolerances::slit_rounding * slit;
  auto mesh = std::make_shared<TriangleMesh>();
  std::vector<Polygon> pieces;
  std::vector<const Solid*> near;
  for (const Solid& own : solids) {
    near.clear();
    for (const Solid& other : solids)
      if (&other != &own && other.reach.meets(own.reach, 4 * slit)) near.push_back(&other);
    for (const Plane& plane : own.planes) {
      pieces = {face_of(own, plane, rounding)};
      if (pieces[0].size() < 3) continue;
      for (const Solid* other : near) take_out(*other, plane.normal, slit, rounding, pieces);
      for (const Polygon& p : pieces) append(*mesh, p, rounding);
    }
  }
  tree_ = all_hierarchies().front().build(std::move(mesh));
}

std::optional<Vec3> BareSurface::nearest(const Vec3& p) const {
  const auto found = tree_->closest(p, 4 * size_);
  if (!found) return std::nullopt;
  return found->point;
}

std::optional<double> BareSurface::ray(const Vec3& p, const Vec3& d) const {
  const auto hit = tree_->ray({p, d}, 4 * size_);
  if (!hit) return std::nullopt;
  return hit->t;
}

}  // namespace tumble
