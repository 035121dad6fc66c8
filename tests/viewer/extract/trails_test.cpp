// Paths of moving bodies. Reference: places and counts worked out by hand from frames built in the
// test.
#include "viewer/render/trails.hpp"

#include "tests/viewer/extract/frame_maker.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// A ball that goes along x with one metre a second, seen at 60 Hz.
Frame moving(FrameMaker& m, uint64_t tick) {
  m.bodies[0].pose.x = Vec3(double(tick) / 60, 1, 0);
  m.frame.tick = tick;
  m.frame.time = double(tick) / 60;
  return m.make();
}

float leftmost(const RenderScene& scene) {
  float x = 1e9f;
  for (const LineSegment& l : scene.lines) x = std::min({x, l.a.x(), l.b.x()});
  return x;
}

}  // namespace

TEST_CASE("trails reach back for their time, to where the body is, and fade") {
  FrameMaker m;
  m.add(shape(ShapeType::sphere), {0, 1, 0});
  m.add(shape(ShapeType::box), {5, 0, 0}, BodyType::fixed);
  Trails trails;
  trails.start(0.5);
  Frame last, now = moving(m, 0);
  trails.see(now);
  for (uint64_t tick = 1; tick <= 90; ++tick) {
    last = now;
    now = moving(m, tick);
    trails.see(now);
  }
  RenderScene scene;
  trails.draw(last, now, 0.5, scene);
  REQUIRE(scene.lines.size() == 31);  // half a second at 60 Hz, begun and ended between two ticks
  CHECK(scene.lines.front().b.x() == doctest::Approx(89.5 / 60));
  CHECK(leftmost(scene) == doctest::Approx(59.0 / 60).epsilon(1e-5));
  for (size_t i = 1; i < scene.lines.size(); ++i) {
    CHECK(scene.lines[i].b == scene.lines[i - 1].a);
    CHECK(scene.lines[i].colour.w() < scene.lines[i - 1].colour.w());
  }

  SUBCASE("going back takes away what came after") {
    m.bodies[0].jumped = true;  // as every body of a world that was put back
    now = moving(m, 70);
    for (int pictures = 0; pictures < 3; ++pictures) trails.see(now);
    m.bodies[0].jumped = false;
    trails.see(moving(m, 71));
    scene.clear_content();
    trails.draw(now, now, 1, scene);
    CHECK(scene.lines.front().b.x() == doctest::Approx(70.0 / 60));
    CHECK(leftmost(scene) == doctest::Approx(59.0 / 60).epsilon(1e-5));
  }
  SUBCASE("a jump ends the path") {
    m.bodies[0].jumped = true;
    now = moving(m, 91);
    trails.see(now);
    m.bodies[0].jumped = false;
    now = moving(m, 92);
    trails.see(now);
    scene.clear_content();
    trails.draw(now, now, 1, scene);
    CHECK(leftmost(scene) == doctest::Approx(91.0 / 60));
  }
  SUBCASE("another body in its place has no path yet") {
    m.bodies[0].id.generation = 2;
    now = moving(m, 91);
    trails.see(now);
    scene.clear_content();
    trails.draw(now, now, 1, scene);
    CHECK(scene.lines.empty());
  }
}

TEST_CASE("trails of many bodies and long times stay few lines, whichever ticks are seen") {
  for (const uint64_t step : {1u, 3u}) {
    FrameMaker m;
    for (int i = 0; i < 3000; ++i) m.add(shape(ShapeType::sphere), {double(i), 1, 0});
    Trails trails;
    trails.start(3600);
    Frame now;
    for (uint64_t tick = 0; tick <= 3000; tick += step * 100) {
      now = moving(m, tick);
      trails.see(now);
    }
    RenderScene scene;
    trails.draw(now, now, 1, scene);
    CHECK(scene.lines.size() <= 60000);
  }
}

TEST_CASE("particles have paths of the length that their look says, through boxes none") {
  ParticleFrame system;
  system.id = {0, 1};
  system.look.trail = 0.25;
  system.ids = {4, 9};
  system.colour = {Vec3f(1, 0, 0), Vec3f(0, 1, 0)};
  system.radius = {0.1, 0.1};
  system.mass = {1, 1};
  system.box = {Vec3(-1, -1, -1), Vec3(2, 0, 0)};
  Trails trails;
  trails.start(0);
  Frame last, now;
  const auto at = [&](uint64_t tick) {
    Frame frame;
    frame.tick = tick;
    frame.time = double(tick) / 60;
    system.x = {Vec3(0, frame.time, 0), system.box.wrapped({0.9 + 0.6 * frame.time, 0, 0})};
    frame.particles = {std::make_shared<const ParticleFrame>(system)};
    return frame;
  };
  for (uint64_t tick = 0; tick <= 60; ++tick) {
    last = now;
    now = at(tick);
    trails.see(now);
  }
  RenderScene scene;
  trails.draw(last, now, 1, scene);
  double lowest = 9, least = 9, greatest = -9;
  size_t red = 0;
  for (const LineSegment& line : scene.lines) {
    const bool first = line.colour.x() == 1;
    red += first;
    if (first) lowest = std::min(lowest, double(line.a.y()));
    if (first) continue;
    least = std::min(least, double(line.a.x()));
    greatest = std::max(greatest, double(line.b.x()));
  }
  CHECK(red == 15);  // a quarter of a second at 60 Hz
  CHECK(lowest == doctest::Approx(45.0 / 60));
  CHECK(least == doctest::Approx(-0.65).epsilon(1e-5));  // 1.5 - 0.15, seen from the other side
  CHECK(greatest == doctest::Approx(-0.5));

  SUBCASE("to one side of a face only") {
    now = at(61);
    trails.see(now);
    for (uint64_t tick = 0; tick <= 12; ++tick) trails.see(at(tick));
    scene.clear_content();
    trails.draw(at(11), at(12), 1, scene);
    for (const LineSegment& line : scene.lines) CHECK((line.a - line.b).norm() < 0.1f);
  }
}
