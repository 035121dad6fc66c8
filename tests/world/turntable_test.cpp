// Reference: a ball that rolls on a turning table without slipping has the acceleration 2/7 W x v,
// so one whose centre is at rest stays where it is, however fast it turns (Burns, American Journal
// of Physics 49, 1981).
#include "tests/support/test_world.hpp"

using namespace tumble;
using namespace tumble::test;

TEST_CASE("realtime: a ball at rest on a turning table stays there, turning slowly or fast") {
  constexpr double radius = 0.1, at = 1;
  for (const double rate : {0.5, 2.0, 4.0}) {  // in a tick the ball turns by .08, .33 and .67
    CAPTURE(rate);
    TestWorld w;
    BodyDef table = TestWorld::box_def({0, -0.1, 0}, {3, 0.1, 3});
    table.type = BodyType::kinematic;
    table.angular_velocity = {0, rate, 0};
    table.shapes[0].material.friction = 1;
    table.shapes[0].material.rolling_friction = 0;
    table.shapes[0].material.torsional_friction = 0;
    w.add(table);
    BodyDef ball = TestWorld::sphere_def({at, radius, 0}, radius);
    ball.angular_velocity = {rate * at / radius, 0, 0};
    ball.shapes[0].material.friction = 1;
    ball.shapes[0].material.rolling_friction = 0;
    ball.shapes[0].material.torsional_friction = 0;
    const BodyId b = w.add(ball);
    w.run(1);
    CHECK(w.body(b).v.norm() < 2e-3 * rate * at);
    CHECK((w.body(b).pose.x - Vec3(at, radius, 0)).norm() < 2e-3);
  }
}
