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
  Vec3 way = Vec3::Zero();  ///< from the centre to the wall that it touches
};

bool meet(const Ball& a, const Ball& b) {
  return (a.centre - b.centre).norm() < a.radius + b.radius;
}

/// All shapes of a body, of which the convex ones are looked through.
class Union {
 public:
  explicit Union(std::span<const BodyShape> shapes) : shapes_(shapes) {
    for (const BodyShape& s : shapes)
      if (s.shape->convex()) size_ = std::max(size_, s.pose.x.norm() + s.shape->bounding_radius());
  }

  /// The ball about a point of a convex shape.
  Ball ball_about(const Vec3& middle, const BodyShape& shape) {
    static const std::vector<Vec3> even = even_directions();
    Ball ball{middle, 2 * size_};
    tried_.clear();
    constexpr size_t few = 8;  // after which only what is near is left to look at
    for (size_t i = 0; i < even.size(); ++i) {
      if (i == 0 || i == few) take_near(middle, ball.radius);
      // Neighbours are far apart in the list's order, so that the first few see all sides.
      try_way(even[i * tolerances::inner_ray_stride % even.size()], shape, ball);
    }
    for (const BodyShape* s : near_) towards_faces(*s, shape, ball);
    return ball;
  }

  /// The ball that a point leads to: on and on to the middle between the nearest wall and the one
  /// behind it, while that makes the ball larger. From the corner of a block to the block's middle,
  /// from the rim of a disc to the disc's middle plane.
  Ball ball_beyond(const Vec3& p, const BodyShape& shape) {
    constexpr int most_steps = 16;
    constexpr int most_idle = 2;  // at a corner the ball grows when all three walls are left behind
    Ball ball = ball_about(p, shape), best = ball;
    int idle = 0;
    for (int step = 0; step < most_steps; ++step) {
      take_near(ball.centre, 2 * size_);
      const double behind = way_out(ball.centre, -ball.way, shape, 2 * size_);
      ball = ball_about(ball.centre - 0.5 * (behind - ball.radius) * ball.way, shape);
      idle = ball.radius > tolerances::larger_ball * best.radius ? 0 : idle + 1;
      if (idle > most_idle) break;
      if (ball.radius > best.radius) best = ball;
    }
    return best;
  }

 private:
  void take_near(const Vec3& middle, double radius) {
    near_.clear();
    for (const BodyShape& s : shapes_)
      if (s.shape->convex() && (s.pose.x - middle).norm() - s.shape->bounding_radius() < radius)
        near_.push_back(&s);
  }

  void try_way(const Vec3& d, const BodyShape& within, Ball& ball) const {
    const double out = way_out(ball.centre, d, within, ball.radius);
    if (!(out < ball.radius)) return;
    ball.radius = out;
    ball.way = d;
  }

  /// The same along the normals of a shape's faces that are nearer than the ball's radius. A way
  /// that has been tried says nothing new: many shapes of one body have their faces alike.
  void towards_faces(const BodyShape& s, const BodyShape& within, Ball& ball) {
    if (!s.shape->polyhedral()) return;
    if ((s.pose.x - ball.centre).norm() - s.shape->bounding_radius() > ball.radius) return;
    const MeshSurface& surface = s.shape->polyhedral()->surface();
    const Vec3 from = s.pose.inverse_point(ball.centre);
    for (size_t t = 0; t < surface.mesh->triangles.size(); ++t) {
      const TriangleMesh& m = *surface.mesh;
      const Vec3 n = (m.corner(t, 1) - m.corner(t, 0)).cross(m.corner(t, 2) - m.corner(t, 0));
      const double length = n.norm(), height = n.dot(m.corner(t, 0) - from);
      if (!(length > 0) || !(height >= 0) || height > ball.radius * length) continue;
      const Vec3 d = s.pose.direction(n / length);
      if (std::ranges::any_of(tried_, [&](const Vec3& known) {
            return (known - d).squaredNorm() < tolerances::same_way * tolerances::same_way;
          }))
        continue;
      tried_.push_back(d);
      try_way(d, within, ball);
    }
  }

  /// How far a ray from inside a shape goes before it leaves all of them, at most `enough`.
  double way_out(const Vec3& from, const Vec3& d, const BodyShape& within, double enough) const {
    const double slit = tolerances::inner_slit * size_;
    double reach = enters(within, from, d) > slit ? 0 : std::max(leaves(within, from, d), 0.0);
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
  std::vector<Vec3> tried_;             ///< normals of faces, from the present middle
  double size_ = 0;                     ///< all convex shapes are this near to the origin [m]
};

/// The balls of a body's convex shapes, and how thick its parts are by them.
class Thickness {
 public:
  explicit Thickness(std::span<const BodyShape> shapes) : all_(shapes) {
    for (const BodyShape& s : shapes)
      if (s.shape->convex())
        balls_.push_back(all_.ball_about(s.pose.point(s.shape->convex()->centre()), s));
  }

  /// The largest ball that meets one, and at least `least`.
  double at(const Ball& mine, double least) const {
    for (const Ball& b : balls_)
      if (b.radius > least && meet(b, mine)) least = b.radius;
    return std::max(least, mine.radius);
  }

  /// Of a convex shape: in its middle, and where it sticks out of all of the balls.
  double of(const BodyShape& s) {
    constexpr int looks = 8;  // from the middle to the end: what is bare for less may be missed
    const double own = s.shape->inner_radius();
    const ConvexShape& shape = *s.shape->convex();
    double least = at(all_.ball_beyond(s.pose.point(shape.centre()), s), own);
    for (const Vec3& d : outward_) {
      const Vec3 middle = shape.centre();
      const Vec3 way = shape.support(d) + shape.rounding() * d - middle;
      const double length = way.norm();
      if (!(length > 2 * own)) continue;
      for (int k = looks; k > 0 && least > tolerances::larger_ball * own; --k) {
        const Vec3 p = s.pose.point(middle + double(k) / looks * (1 - 2 * own / length) * way);
        if (std::ranges::any_of(balls_, [&](const Ball& b) { return meet(b, {p, 0}); })) continue;
        least = std::min(least, at(all_.ball_beyond(p, s), own));
      }
    }
    return least;
  }

 private:
  static std::vector<Vec3> outward() {
    std::vector<Vec3> out;
    for (int k = 0; k < 27; ++k)
      if (k != 13) out.push_back(Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1).normalized());
    return out;
  }

  Union all_;
  std::vector<Ball> balls_;
  std::vector<Vec3> outward_ = outward();  ///< to the sides, edges and corners of a cube
};

}  // namespace

double inner_radius_of(std::span<const BodyShape> shapes) {
  if (shapes.size() == 1) return shapes[0].shape->inner_radius();
  Thickness thickness(shapes);
  std::vector<const BodyShape*> thinnest_first;
  for (const BodyShape& s : shapes) thinnest_first.push_back(&s);
  std::ranges::stable_sort(thinnest_first, {},
                           [](const BodyShape* s) { return s->shape->inner_radius(); });
  double least = shapes.empty() ? 0 : std::numeric_limits<double>::infinity();
  for (const BodyShape* s : thinnest_first) {
    const double own = s->shape->inner_radius();
    if (own >= least) break;  // no shape counts less than its own
    least = std::min(least, s->shape->convex() ? thickness.of(*s) : own);
  }
  return least;
}

}  // namespace tumble
