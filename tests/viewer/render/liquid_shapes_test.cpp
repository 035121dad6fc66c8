// The ellipsoids that make the surface of a liquid. References: the half-space (its normal, and
// rays sent through all ellipsoids one by one), turning everything, neighbours summed by hand.
#include "viewer/render/liquid_shapes.hpp"

#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr double spacing = 0.1;

/// Particles of a block, the surface of which is half a spacing above the highest of them, y = 0;
/// each is moved by up to `off` spacings along each axis.
std::vector<Vec3> pool(double off, int layers = 8, int across = 20) {
  Random r(3);
  std::vector<Vec3> x;
  for (int j = 0; j < layers; ++j)
    for (int i = 0; i < across; ++i)
      for (int k = 0; k < across; ++k)
        x.push_back(spacing * (Vec3(i, -j - 0.5, k) +
                               off * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1))));
  return x;
}
std::vector<LiquidShape> shapes_of(const std::vector<Vec3>& x, double whole = 1) {
  return liquid_shapes(LiquidNeighbours(x, spacing), std::vector<double>(x.size(), whole));
}
/// In the middle of the block, in that layer.
size_t middle(int layer) {
  return size_t(layer) * 400 + 210;
}

/// Where a ray downwards meets the ellipsoid of longest half axis `radius`; -infinity: nowhere.
double height_over(const LiquidShape& s, double radius, double x, double z) {
  // |M (x + y up)|^2 = radius^2 is quadratic in y.
  const Vec3 p = s.to_ball * Vec3(x - s.centre[0], 0, z - s.centre[2]), u = s.to_ball.col(1);
  const double uu = u.squaredNorm(), pu = p.dot(u);
  const double root = pu * pu - uu * (p.squaredNorm() - radius * radius);
  if (root < 0) return -std::numeric_limits<double>::infinity();
  return s.centre[1] + (-pu + std::sqrt(root)) / uu;
}

/// Mean and spread of the surface in the middle of the block, in spacings.
struct Roughness {
  double mean = 0, spread = 0;
};
Roughness roughness(const std::vector<LiquidShape>& shapes) {
  double sum = 0, squares = 0;
  int n = 0;
  for (double x = 0.6; x < 1.4; x += 0.023)
    for (double z = 0.6; z < 1.4; z += 0.023, ++n) {
      double top = -1;
      for (const LiquidShape& s : shapes)
        top = std::max(top, height_over(s, 0.85 * spacing, x, z) / spacing);
      sum += top;
      squares += top * top;
    }
  return {sum / n, std::sqrt(squares / n - sum / n * sum / n)};
}

}  // namespace

TEST_CASE("liquid shapes: balls inside, flat at the surface, across its normal") {
  const std::vector<Vec3> x = pool(0);
  const std::vector<LiquidShape> shapes = shapes_of(x);
  const LiquidShape& inside = shapes[middle(4)];
  CHECK(inside.to_ball == Mat3::Identity());
  CHECK(inside.centre == x[middle(4)]);
  const LiquidShape& top = shapes[middle(0)];
  const Vec3 up = top.to_ball * Vec3::UnitY();
  CHECK((up / up.norm() - Vec3::UnitY()).norm() < 1e-9);
  CHECK(1 / up.norm() > 0.35);
  CHECK(1 / up.norm() < 0.65);
  CHECK((top.to_ball * Vec3::UnitX() - Vec3::UnitX()).norm() < 1e-9);
}

TEST_CASE("liquid shapes: a plane surface of particles out of order is smoother than its balls") {
  for (const double off : {0.0, 0.2}) {
    CAPTURE(off);
    const std::vector<Vec3> x = pool(off);
    const Roughness balls = roughness(shapes_of(x, 0)), flat = roughness(shapes_of(x));
    CHECK(flat.spread < 0.65 * balls.spread);
    CHECK(balls.mean > 0.2);
    CHECK(std::fabs(flat.mean) < 0.1);
  }
}

TEST_CASE("liquid shapes: they turn with the liquid") {
  const std::vector<Vec3> x = pool(0.2, 4, 8);
  const Quat q = axis_angle(Vec3(0.4, -1.1, 0.7).normalized(), 1.3);
  std::vector<Vec3> turned;
  for (const Vec3& at : x) turned.push_back(q * at + Vec3(3, -2, 5));
  const std::vector<LiquidShape> a = shapes_of(x), b = shapes_of(turned);
  const Mat3 R = q.toRotationMatrix();
  for (size_t i = 0; i < x.size(); ++i) {
    CHECK((q * a[i].centre + Vec3(3, -2, 5) - b[i].centre).norm() < 1e-10);
    CHECK((R * a[i].to_ball * R.transpose() - b[i].to_ball).norm() < 1e-6);
  }
}

TEST_CASE("liquid shapes: of a plane layer particles stay, and what is out of it moves back") {
  for (const double off : {-0.25, -0.1, 0.0, 0.1, 0.25}) {
    CAPTURE(off);
    std::vector<Vec3> x = pool(0);
    const size_t i = middle(0);
    x[i][1] += off * spacing;
    const Vec3 moved = (shapes_of(x)[i].centre - x[i]) / spacing;
    CHECK(moved[1] == doctest::Approx(-0.8 * off).epsilon(0.35).scale(0.005));
    CHECK(std::hypot(moved[0], moved[2]) < 1e-12);
    CHECK((shapes_of(x, 0.5)[i].centre - x[i] - 0.5 * spacing * moved).norm() < 1e-12);
  }
}

TEST_CASE("liquid shapes: drops, what has no neighbours, and no liquid at all") {
  const std::vector<Vec3> x{{0, 0, 0}, {0.15, 0, 0}, {5, 0, 0}};
  const std::vector<LiquidShape> drops = shapes_of(x, 0);
  for (size_t i = 0; i < x.size(); ++i) {
    CHECK(drops[i].centre == x[i]);
    CHECK(drops[i].to_ball == Mat3::Identity());
  }
  CHECK(shapes_of(x)[2].to_ball == Mat3::Identity());
  CHECK(shapes_of({}).empty());
  const std::vector<Vec3> nowhere{{0, 0, 0}, Vec3::Constant(std::nan(""))};
  CHECK(shapes_of(nowhere).size() == 2);
}
