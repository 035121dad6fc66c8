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
