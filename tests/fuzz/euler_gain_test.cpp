// What the judge of random scenes lets explicit Euler gain. Reference: the closed form. On a linear
// spring of frequency w a step of h takes x + i v / w to (1 - i w h) times it, so that each
// multiplies the energy by 1 + w^2 h^2.
#include "tests/fuzz/euler_gain.hpp"

#include "engine/world/world.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>
#include <optional>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr double step_turn = 0.05;  ///< w h of every case [-]
constexpr double rate = 60 * step_turn;

/// A ball without weight under explicit Euler, and what it gains.
struct Swing {
  std::unique_ptr<World> world;
  BodyId ball;
  std::optional<EulerGain> gain;
  double start = 0;  ///< [J]

  explicit Swing(const Vec3& x, const Vec3& v) {
    WorldDef def;
    def.settings.gravity = Vec3::Zero();
    def.settings.stepper = "event";
    def.settings.event.integrator = "explicit_euler";
    auto made = World::create(std::move(def));
    REQUIRE_MESSAGE(made.ok(), test::why_not(made));
    world = *std::move(made);
    BodyDef body;
    body.pose.x = x;
    body.velocity = v;
    body.shapes.emplace_back();
    body.shapes[0].shape.type = ShapeType::sphere;
    body.shapes[0].shape.radius = radius;
    body.mass = mass;
    ball = *world->create_body(body);
  }
  /// A spring without length from the origin.
  void tie() {
    SpringDef spring;
    spring.a.kind = Anchor::Kind::world;
    spring.b.kind = Anchor::Kind::body;
    spring.b.body = ball;
    spring.stiffness = mass * rate * rate;
    spring.damping = spring.rest_length = 0;
    REQUIRE(world->create_force(spring).ok());
  }
  /// A hinge through its centre with a spring that is wound by an angle.
  void wind(double angle) {
    JointDef hinge;
    hinge.name = "hinge";
    hinge.kind = JointKind::revolute;
    hinge.b = ball;
    hinge.drives[0].spring = {inertia * rate * rate, 0, angle};
    const auto id = world->create_joint(hinge);
    REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  }
  void run(int ticks) {
    REQUIRE(world->apply_commands().ok());
    start = energy();
    gain.emplace(*world->frame());
    for (int i = 0; i < ticks; ++i) {
      const auto done = world->step();
      REQUIRE_MESSAGE(done.ok(), test::why_not(done));
      gain->add_tick(*world->frame());
    }
  }
  double energy() const { return world->frame()->stats.energies.total(); }

  static constexpr double mass = 2, radius = 0.1, inertia = 0.4 * mass * radius * radius;
};

/// Of so many steps, in shares of the first energy.
double closed_form(int steps) {
  return std::pow(1 + step_turn * step_turn, steps) - 1;
}

/// Ticks of whole swings.
int ticks_of(int swings) {
  return int(std::lround(swings * 2 * M_PI / std::atan(step_turn)));
}

}  // namespace

TEST_CASE("random scenes: explicit Euler may gain on a circle what its formula says, each step") {
  // Acceleration is the same all round, so that twice the first term is the whole of it.
  for (const int ticks : {1, 30, 200}) {
    Swing circle({0.5, 0, 0}, {0, 0.5 * rate, 0});
    circle.tie();
    circle.run(ticks);
    CAPTURE(ticks);
    const double expected = closed_form(ticks) * circle.start;
    CHECK(std::fabs(circle.energy() - circle.start - expected) < 1e-9 * expected);
    CHECK(std::fabs(circle.gain->total() - expected) < 1e-9 * expected);
  }
}

TEST_CASE("random scenes: explicit Euler may gain in whole swings what its formula says") {
  const int ticks = ticks_of(3);
  Swing line({0.5, 0, 0}, Vec3::Zero());
  line.tie();
  Swing turn(Vec3::Zero(), Vec3::Zero());
  turn.wind(0.4);
  for (Swing* s : {&line, &turn}) {
    s->run(ticks);
    CAPTURE(s->start);
    const double expected = closed_form(ticks) * s->start;
    CHECK(std::fabs(s->energy() - s->start - expected) < 1e-3 * expected);
    CHECK(std::fabs(s->gain->total() - expected) < 0.01 * expected);
  }
}
