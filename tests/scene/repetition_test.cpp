// Places of copies against closed forms written out here: grid, stack, ring, formula; scatter
// against its own promise (inside the region, no two nearer than the least distance), and the
// uniformity of random rotations against the moments of the uniform distribution.
#include "engine/scene/repetition.hpp"

#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/scene/scene_text.hpp"

#include <cmath>

using namespace tumble;

namespace {

constexpr double pi = 3.14159265358979323846;

struct Copies {
  SceneDescription scene;
  BodyDescription body;
  std::vector<std::string> warnings;

  template <class Kind>
  Kind& add() {
    return body.repeat.emplace_back().kind.emplace<Kind>();
  }
  std::vector<Pose> poses() {
    auto made = copy_poses(scene, "b", body, warnings);
    REQUIRE(made.ok());
    return *made;
  }
};

bool near(const Vec3& a, const Vec3& b) {
  return (a - b).norm() < 1e-12;
}
bool near(const Quat& a, const Quat& b) {
  return std::fabs(std::fabs(a.dot(b)) - 1) < 1e-12;
}

}  // namespace

TEST_CASE("no repetition is one copy in the body's place") {
  Copies c;
  c.body.placement.position = {1, 2, 3};
  REQUIRE(c.poses().size() == 1);
  CHECK(c.poses()[0].x == Vec3(1, 2, 3));
}

TEST_CASE("grid: numbering, centring, stagger") {
  Copies c;
  c.body.placement.position = {10, 20, 30};
  auto& grid = c.add<GridRepetition>();
  grid.count = {3, 2, 4};
  grid.spacing = {2, 5, 0.5};
  grid.stagger = {0.25, 0, 0};
  const auto poses = c.poses();
  REQUIRE(poses.size() == 24);
  for (int y = 0; y < 2; ++y)
    for (int z = 0; z < 4; ++z)
      for (int x = 0; x < 3; ++x) {
        const Vec3 expected(10 + 2.0 * (x - 1) + (y == 1 ? 0.25 : 0), 20 + 5.0 * y,
                            30 + 0.5 * (z - 1.5));
        CHECK(near(poses[size_t((y * 4 + z) * 3 + x)].x, expected));
      }
  std::get<GridRepetition>(c.body.repeat[0].kind).centred = false;
  CHECK(near(c.poses()[0].x, {10, 20, 30}));
}

TEST_CASE("stack: steps and turns, the body's own orientation comes first") {
  Copies c;
  c.body.placement.euler_deg = Vec3(0, 0, 90);
  auto& stack = c.add<StackRepetition>();
  stack.count = 4;
  stack.step = {0.1, 1, 0};
  stack.turn_deg = 30;
  const auto poses = c.poses();
  REQUIRE(poses.size() == 4);
  for (int i = 0; i < 4; ++i) {
    CHECK(near(poses[size_t(i)].x, Vec3(0.1 * i, i, 0)));
    const Quat expected = axis_angle(Vec3::UnitY(), i * pi / 6) * axis_angle(Vec3::UnitZ(), pi / 2);
    CHECK(near(poses[size_t(i)].q, expected));
  }
}

TEST_CASE("ring: full circle and arc, every axis") {
  for (const RingAxis axis : {RingAxis::x, RingAxis::y, RingAxis::z})
    for (const double arc : {360.0, 180.0}) {
      Copies c;
      auto& ring = c.add<RingRepetition>();
      ring.count = 5;
      ring.radius = 2;
      ring.axis = axis;
      ring.arc_deg = arc;
      ring.start_deg = 10;
      const auto poses = c.poses();
      REQUIRE(poses.size() == 5);
      for (int i = 0; i < 5; ++i) {
        const double a = (10 + arc * i / (arc == 360 ? 5 : 4)) * pi / 180;
        const Vec3 expected = axis == RingAxis::y   ? Vec3(2 * std::cos(a), 0, -2 * std::sin(a))
                              : axis == RingAxis::z ? Vec3(2 * std::cos(a), 2 * std::sin(a), 0)
                                                    : Vec3(0, 2 * std::cos(a), 2 * std::sin(a));
        CHECK(near(poses[size_t(i)].x, expected));
        // Copies turn so that one axis of theirs keeps pointing outwards.
        const Vec3 outward = axis == RingAxis::x ? Vec3::UnitY() : Vec3::UnitX();
        CHECK(near(poses[size_t(i)].direction(outward), expected / 2));
      }
    }
}

TEST_CASE("formula sees i, n, u and the parameters") {
  Copies c;
  ParameterDescription r;
  r.value = 3;
  c.scene.parameters_.add("r", r);
  auto& f = c.add<FormulaRepetition>();
  f.count = 6;
  f.position = {"r * cos(i)", "u", "n"};
  f.euler_deg = {"0", "15 * i", "0"};
  const auto poses = c.poses();
  REQUIRE(poses.size() == 6);
  for (int i = 0; i < 6; ++i) {
    CHECK(near(poses[size_t(i)].x, Vec3(3 * std::cos(i), i / 5.0, 6)));
    CHECK(near(poses[size_t(i)].q, axis_angle(Vec3::UnitY(), i * pi / 12)));
  }
  std::get<FormulaRepetition>(c.body.repeat[0].kind).position[1] = "1 / (i - 3)";
  const auto bad = copy_poses(c.scene, "b", c.body, c.warnings);
  REQUIRE_FALSE(bad.ok());
  CHECK(bad.error().place == "bodies.b.repeat[0]");
  CHECK(bad.error().message.find("position[1] for copy 3") != std::string::npos);
}

TEST_CASE("nested repetitions: inner copies turn along with the outer ones") {
  Copies c;
  auto& ring = c.add<RingRepetition>();
  ring.count = 4;
  ring.radius = 10;
  auto& row = c.add<StackRepetition>();
  row.count = 3;
  row.step = {1, 0, 0};
  const auto poses = c.poses();
  CHECK(copy_count(c.body) == 12);
  REQUIRE(poses.size() == 12);
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k) {
      const double a = i * pi / 2;
      CHECK(near(poses[size_t(3 * i + k)].x, (10.0 + k) * Vec3(std::cos(a), 0, -std::sin(a))));
    }
}

TEST_CASE("scatter keeps its region and distance, and says when it is full") {
  for (const ScatterRegion region : {ScatterRegion::box, ScatterRegion::ball}) {
    Copies c;
    auto& s = c.add<ScatterRepetition>();
    s.count = scaled_count(400);
    s.region = region;
    s.size = {4, 6, 2};
    s.min_distance = 0.1;
    const auto poses = c.poses();
    REQUIRE(poses.size() == size_t(s.count));
    for (size_t i = 0; i < poses.size(); ++i) {
      const Vec3 u = poses[i].x.cwiseQuotient(s.size);
      CHECK(u.cwiseAbs().maxCoeff() <= 0.5);
      if (region == ScatterRegion::ball) CHECK(u.norm() <= 0.5 + 1e-12);
      for (size_t k = 0; k < i; ++k) CHECK((poses[i].x - poses[k].x).norm() >= 0.1);
    }
    CHECK(c.warnings.empty());
    s.min_distance = 5;
    CHECK(c.poses().size() < 10);
    CHECK(c.warnings.size() == 1);
  }
}

TEST_CASE("scatter depends on seed and name only, not on other bodies") {
  Copies a, b;
  for (Copies* c : {&a, &b}) c->add<ScatterRepetition>().count = 5;
  b.scene.bodies.add("another");
  CHECK(a.poses()[4].x == b.poses()[4].x);
  b.scene.seed = 2;
  CHECK(a.poses()[4].x != b.poses()[4].x);
}

TEST_CASE("jitter stays within its bounds") {
  Copies c;
  auto& points = c.add<PointsRepetition>();
  points.points.assign(200, Vec3::Zero());
  c.body.repeat[0].jitter = {0.5, 0, 0.25};
  c.body.repeat[0].jitter_deg = 10;
  double largest_x = 0, largest_angle = 0;
  for (const Pose& p : c.poses()) {
    CHECK(std::fabs(p.x.x()) <= 0.5);
    CHECK(p.x.y() == 0);
    CHECK(std::fabs(p.x.z()) <= 0.25);
    const double angle = 2 * std::acos(std::min(1.0, std::fabs(p.q.w()))) * 180 / pi;
    CHECK(angle <= 10 + 1e-6);
    largest_x = std::max(largest_x, std::fabs(p.x.x()));
    largest_angle = std::max(largest_angle, angle);
  }
  CHECK(largest_x > 0.4);
  CHECK(largest_angle > 8);
}

TEST_CASE("random rotations are uniform: every entry of R has mean 0 and mean square 1/3") {
  Random random(3);
  const int n = 20000;
  Mat3 mean = Mat3::Zero(), square = Mat3::Zero();
  for (int i = 0; i < n; ++i) {
    const Quat q = random_rotation(random);
    REQUIRE(std::fabs(q.norm() - 1) < 1e-12);
    const Mat3 R = q.toRotationMatrix();
    mean += R / n;
    square += R.cwiseProduct(R) / n;
  }
  // Four standard deviations of a mean over n draws.
  CHECK(mean.cwiseAbs().maxCoeff() < 4 * std::sqrt(1.0 / 3 / n));
  CHECK((square - Mat3::Constant(1.0 / 3)).cwiseAbs().maxCoeff() < 4 * 0.3 / std::sqrt(double(n)));
}
