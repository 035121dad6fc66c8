#include "engine/dynamics/bodies/inner_ball.hpp"

#include "engine/dynamics/bodies/tolerances.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// A ball, with points of the walls that it touches or would touch after a short step.
class GrowingBall {
 public:
  GrowingBall(const BareSurface& surface, const Vec3& centre) : surface_(surface) {
    go(look(centre));
  }
  const InnerBall& ball() const { return now_.ball; }

  /// Moves to a larger ball; returns whether there is one.
  bool step() {
    if (slide()) return true;
    // Walls farther behind may have blocked the way.
    walls_ = {now_.wall};
    return slide() || jump();
  }

 private:
  struct Look {
    InnerBall ball;
    Vec3 wall;
  };
  Look look(const Vec3& p) const {
    const Vec3 wall = surface_.nearest(p).value_or(p);
    return {{p, (wall - p).norm()}, wall};
  }

  std::vector<Vec3> ways() const {
    std::vector<Vec3> out;
    for (const Vec3& w : walls_) out.push_back((w - now_.ball.centre).normalized());
    return out;
  }

  void go(const Look& to) {
    now_ = to;
    // Distant walls do not affect where the ball grows. Those that it will soon touch again are
    // kept, so that it does not zigzag between them.
    const double near = tolerances::wall_near_ball * to.ball.radius;
    std::erase_if(walls_, [&](const Vec3& w) { return (w - to.ball.centre).norm() > near; });
    remember(to.wall);
  }

  void remember(const Vec3& wall) {
    if (walls_.size() == tolerances::ball_walls) walls_.erase(walls_.begin());
    walls_.push_back(wall);
  }

  /// Moves away from the walls, by shorter and shorter steps; a wall that stops the shortest one is
  /// added.
  bool slide() {
    const double radius = now_.ball.radius;
    for (size_t tries = 0; tries < tolerances::ball_walls; ++tries) {
      const Vec3 towards = shortest_of_hull(ways());
      const double slope = towards.norm();
      if (slope <= tolerances::even_slope) break;
      Look to;
      for (double s = radius; s > tolerances::least_ball_step * radius; s *= 0.25) {
        to = look(now_.ball.centre - s / slope * towards);
        if (to.ball.radius < radius + tolerances::ball_step_gain * s * slope) continue;
        go(to);
        return true;
      }
      remember(to.wall);
    }
    return false;
  }

  /// Moves to the middle between a wall and the one opposite: exact for parallel walls.
  bool jump() {
    for (const Vec3& w : walls_) {
      const Vec3 way = now_.ball.centre - w;
      const double length = way.norm();
      if (!(length > 0)) continue;
      const auto behind = surface_.ray(now_.ball.centre, way / length);
      if (!behind) continue;
      const Look to = look(now_.ball.centre + 0.5 * (*behind - length) / length * way);
      if (to.ball.radius <= tolerances::larger_ball * now_.ball.radius) continue;
      go(to);
      return true;
    }
    return false;
  }

  const BareSurface& surface_;
  Look now_;
  std::vector<Vec3> walls_;
};

}  // namespace

InnerBall ball_about(const BareSurface& surface, const Vec3& p) {
  const auto wall = surface.nearest(p);
  return {p, wall ? (*wall - p).norm() : 2 * surface.size()};
}

InnerBall grown_ball(const BareSurface& surface, const Vec3& p, double enough) {
  GrowingBall growing(surface, p);
  for (int i = 0; i < tolerances::most_ball_steps && growing.ball().radius < enough; ++i)
    if (!growing.step()) break;
  return growing.ball();
}

Vec3 shortest_of_hull(const std::vector<Vec3>& vectors) {
  // The shortest vector of the hull is that of one, two or three of the vectors, and no other
  // vector has a smaller component along it; if there is no such vector the hull contains zero.
  Vec3 best = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Vec3& v) {
    if (v.squaredNorm() >= least) return;
    for (const Vec3& other : vectors)
      if (other.dot(v) < v.squaredNorm() - tolerances::shortest_rounding) return;
    least = v.squaredNorm();
    best = v;
  };
  const size_t n = vectors.size();
  for (size_t i = 0; i < n; ++i) offer(vectors[i]);
  for (size_t i = 0; i < n; ++i)
    for (size_t j = i + 1; j < n; ++j) {
      offer(closest_on_segment(Vec3::Zero(), vectors[i], vectors[j]).point);
      for (size_t k = j + 1; k < n; ++k)
        offer(closest_on_triangle(Vec3::Zero(), vectors[i], vectors[j], vectors[k]).point);
    }
  return best;
}

}  // namespace tumble
