// Mechanisms on which nothing acts: what begins nearly at rest must not set itself in motion. On a
// light rod with heavy chains sweeps over joints converge slowly, and what is remembered of errors
// from sub-step to sub-step drives such modes. Reference: without forces energy only falls.
#include "engine/core/random.hpp"
#include "tests/dynamics/joint_world.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

struct Chain {
  int links;
  double length;  ///< of a link [m]
  double mass;    ///< likewise [kg]
  double radius;  ///< [m]
};

/// A thin rod of 1 kg along x, on ball joints at four points of its axis a chain of balls, without
/// gravity: in one ordinary island.
struct RodWithChains : JointWorld {
  explicit RodWithChains(const Chain& chain) {
    gravity.setZero();
    BodyDef d = body(box(0.7, 0.02, 0.02), Vec3::Zero());
    d.mass = 1;
    const uint32_t rod = add(d);
    for (const double x : {-0.6, -0.35, 0.35, 0.6}) {
      uint32_t above = rod;
      for (int k = 0; k < chain.links; ++k) {
        BodyDef ball = body(sphere(chain.radius), {x, -chain.length * (k + 0.5), 0});
        ball.mass = chain.mass;
        const uint32_t below = add(ball);
        join(JointKind::spherical, above, below, {{x, -chain.length * k, 0}, Quat::Identity()});
        above = below;
      }
    }
  }
  /// Velocities of up to a millimetre a second.
  void stir(Random& random) {
    const auto some = [&random] { return random.uniform(-1e-3, 1e-3); };
    for (RigidBody& b : bodies) b.v = {some(), some(), some()};
  }
};

/// Greatest kinetic energy in ten seconds, of that after the first tick.
double growth(const Chain& chain, Random& random) {
  RodWithChains w(chain);
  w.stir(random);
  w.step();
  const double start = w.kinetic_energy();
  double most = start;
  for (int tick = 0; tick < 600; ++tick) {
    w.step();
    most = std::max(most, w.kinetic_energy());
  }
  return most / start;
}

}  // namespace

TEST_CASE("heavy chains on a light rod that begin nearly at rest do not set themselves in motion") {
  Random random(5);
  double most = growth({4, 0.28, 26.5, 0.11}, random);
  for (int round = 0; round < scaled_count(40, 8); ++round) {
    const double length = random.uniform(0.1, 0.4);
    most = std::max(most, growth({3 + round % 4, length, random.uniform(8, 29),
                                  std::min(0.11, length * random.uniform(0.1, 0.45))},
                                 random));
  }
  MESSAGE("energy grew at most " << most << " times");
  // Joints that pull tight within the first ticks take from one mode and give to another.
  CHECK(most < 1.1);
}

TEST_CASE("a payload of a thousand links' weight on a hundred links gains no energy at 60 Hz") {
  // From rest, hanging, at an angle and level. Reference: energy only falls, and the pendulum that
  // hangs straight does not move. It sags by what sweeps leave (README of realtime, "Limits").
  constexpr int links = 100;
  constexpr double length = 0.1, radius = 0.3, payload = 1000;
  for (const JointKind kind : {JointKind::spherical, JointKind::revolute})
    for (const double angle : {0.0, 0.3, 1.5}) {
      CAPTURE(int(kind));
      CAPTURE(angle);
      JointWorld w;
      const Vec3 along(std::sin(angle), -std::cos(angle), 0);
      const Quat q(std::cos(0.5 * angle), 0, 0, std::sin(0.5 * angle));
      uint32_t above = no_body;
      const auto hang = [&](BodyDef d, double mass, double at, double anchor) {
        d.mass = mass;
        d.pose = {at * along, q};
        const uint32_t below = w.add(d);
        w.join(kind, above, below, {anchor * along, Quat::Identity()});
        above = below;
      };
      for (int k = 0; k < links; ++k)
        hang(body(box(0.01, 0.5 * length, 0.01), Vec3::Zero()), 1, (k + 0.5) * length, k * length);
      hang(body(sphere(radius), Vec3::Zero()), payload, links * length + radius, links * length);
      const double start = w.energy(), scale = payload * 9.81 * (links * length + radius);
      double most = start, open = 0, sag = 0;
      for (int tick = 0; tick < 120; ++tick) {
        w.step();
        most = std::max(most, w.energy());
        open = std::max(open, w.joint_error());
        sag = std::max(sag, w.bodies[above].pose.x.norm() - links * length - radius);
      }
      CHECK(most - start < 1e-4 * scale);
      CHECK(open < 0.02);
      CHECK(sag < (angle < 1 ? 0.05 : 0.1) * links * length);
    }
}
