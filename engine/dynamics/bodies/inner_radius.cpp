#include "engine/dynamics/bodies/inner_radius.hpp"

#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tumble {
namespace {

/// Directions in even steps over the sphere (Vogel's spiral: equal areas, turned by the golden
/// angle).
std::vector<Vec3> even_directions() {
  std::vector<Vec3> out;
  const double golden = det::pi * (3 - std::sqrt(5.0));
  constexpr int n = tolerances::inner_rays;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - z * z);
    out.emplace_back(r * det::cos(golden * i), z, r * det::sin(golden * i));
  }
  return out;
}

struct Ball {
  Vec3 centre;
  double radius;
};

/// All shapes of a body, of which the convex ones are looked through.
class Union {
 public:
  explicit Union(std::span<const BodyShape> shapes) : shapes_(shapes) {
    for (const BodyShape& s : shapes)
      if (s.shape->convex()) size_ = std::max(size_, s.pose.x.norm() + s.shape->bounding_radius());
  }

  /// The ball about the middle of a convex shape.
  Ball ball_about(const BodyShape& shape) {
    static const std::vector<Vec3> even = even_directions();
    const Vec3 middle = shape.pose.point(shape.shape->convex()->centre());
    double radius = 2 * size_;
    constexpr size_t few = 8;  // after which only what is near is left to look at
    for (size_t i = 0; i < even.size(); ++i) {
      if (i == 0 || i == few) take_near(middle, radius);
      // Neighbours are far apart in the list's order, so that the first few see all sides.
      const size_t turned = i * tolerances::inner_ray_stride % even.size();
      radius = way_out(middle, even[turned], shape, radius);
    }
    for (const BodyShape* s : near_) radius = towards_faces(*s, middle, shape, radius);
    return {middle, radius};
  }

 private:
  void take_near(const Vec3& middle, double radius) {
    near_.clear();
    for (const BodyShape& s : shapes_)
      if (s.shape->convex() && (s.pose.x - middle).norm() - s.shape->bounding_radius() < radius)
        near_.push_back(&s);
  }
  /// The same along the normals of a shape's faces that are nearer than `enough`.
  double towards_faces(const BodyShape& s, const Vec3& middle, const BodyShape& within,
                       double enough) const {
    if (!s.shape->polyhedral()) return enough;
    if ((s.pose.x - middle).norm() - s.shape->bounding_radius() > enough) return enough;
    const MeshSurface& surface = s.shape->polyhedral()->surface();
    const Vec3 from = s.pose.inverse_point(middle);
    for (size_t t = 0; t < surface.mesh->triangles.size(); ++t) {
      const TriangleMesh& m = *surface.mesh;
      const Vec3 n = (m.corner(t, 1) - m.corner(t, 0)).cross(m.corner(t, 2) - m.corner(t, 0));
      const double length = n.norm(), height = n.dot(m.corner(t, 0) - from);
      if (!(length > 0) || !(height >= 0) || height > enough * length) continue;
      enough = way_out(middle, s.pose.direction(n / length), within, enough);
    }
    return enough;
  }

  /// How far a ray from inside a shape goes before it leaves all of them, at most `enough`.
  double way_out(const Vec3& from, const Vec3& d, const BodyShape& within, double enough) const {
    const double slit = tolerances::inner_slit * size_;
    double reach = std::max(leaves(within, from, d), 0.0);
    for (bool farther = true; farther && reach < enough;) {
      farther = false;
      for (const BodyShape* near : near_) {
        const BodyShape& s = *near;
        const double along = d.dot(s.pose.x - from), r = s.shape->bounding_radius();
        if (along + r <= reach || along - r > reach + slit ||
            (from + along * d - s.pose.x).squaredNorm() > r * r)
          continue;
        const double out = leaves(s, from, d);
        if (out <= reach || enters(s, from, d) > reach + slit) continue;
        reach = out;
        farther = true;
      }
    }
    return std::min(reach, enough);
  }

  /// Where the line from + t d leaves a convex shape; minus infinity where it misses it.
  double leaves(const BodyShape& s, const Vec3& from, const Vec3& d) const {
    return -enters(s, from, -d);
  }
  /// Where it enters it; infinity where it misses it.
  double enters(const BodyShape& s, const Vec3& from, const Vec3& d) const {
    const double far = 4 * size_;  // from inside the body to surely outside
    const auto hit = s.shape->ray_cast(s.pose.inverse_point(from - far * d),
                                       s.pose.inverse_direction(d), 2 * far);
    return hit ? hit->t - far : std::numeric_limits<double>::infinity();
  }

  std::span<const BodyShape> shapes_;
  std::vector<const BodyShape*> near_;  ///< convex ones that may reach into the ball
  double size_ = 0;                     ///< all convex shapes are this near to the origin [m]
};

}  // namespace

double inner_radius_of(std::span<const BodyShape> shapes) {
  if (shapes.size() == 1) return shapes[0].shape->inner_radius();
  std::vector<Ball> balls;
  Union all(shapes);
  for (const BodyShape& s : shapes)
    if (s.shape->convex()) balls.push_back(all.ball_about(s));
  double least = shapes.empty() ? 0 : std::numeric_limits<double>::infinity();
  auto own = balls.begin();
  for (const BodyShape& s : shapes) {
    double thick = s.shape->inner_radius();
    if (s.shape->convex()) {
      const Ball& mine = *own++;
      for (const Ball& b : balls)
        if (b.radius > thick && (b.centre - mine.centre).norm() < b.radius + mine.radius)
          thick = b.radius;
    }
    least = std::min(least, thick);
  }
  return least;
}

}  // namespace tumble
