// References: a body that falls flat on several points has one impact along its fall, which neither
// turns it nor moves it sideways; its speed is then e times that of the fall (Newton's law).
#include "tests/support/test_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

BodyDef with_restitution(BodyDef def, double restitution) {
  def.shapes[0].material.friction = 0;
  def.shapes[0].material.restitution = restitution;
  return def;
}

}  // namespace

TEST_CASE("realtime: what falls flat bounces without turning") {
  constexpr double drop = 1;
  constexpr int hz = 240;
  for (const Vec3& half : {Vec3(0.1, 0.1, 0.1), Vec3(0.5, 0.05, 0.15), Vec3(0.2, 0.3, 0.1)})
    for (const double e : {0.3, 0.5, 1.0}) {
      CAPTURE(half.transpose());
      CAPTURE(e);
      WorldSettings settings;
      settings.tick.num = hz;
      TestWorld w(settings);
      BodyDef ground = TestWorld::box_def({0, -1, 0}, {5, 1, 5});
      ground.type = BodyType::fixed;
      w.add(with_restitution(ground, 0));
      const BodyId box =
          w.add(with_restitution(TestWorld::box_def({0, half.y() + drop, 0}, half), e));
      double fall = 0;
      for (int i = 0; i < hz && w.body(box).v.y() <= 0; ++i) {
        fall = std::max(fall, -w.body(box).v.y());
        w.step();
      }
      CHECK(w.body(box).v.y() == doctest::Approx(e * fall).epsilon(0.02));
      CHECK(w.body(box).omega.norm() < 5e-3 * fall / half.minCoeff());
      CHECK(std::hypot(w.body(box).v.x(), w.body(box).v.z()) < 1e-3 * fall);
    }
}
