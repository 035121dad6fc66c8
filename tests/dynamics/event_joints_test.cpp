// Joints under the event stepper. References: the energy of the double pendulum of the published
// comparison; reactions of the conical and of the physical pendulum; the centre of percussion, the
// double pendulum's impulse by Lagrange's equations, and the collision of one merged body.
#include "tests/dynamics/event_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81;

BodyDef slim_rod(const Vec3& centre) {
  BodyDef d = body(box(0.5, 0.05, 0.05), centre);
  d.mass = 1;
  return d;
}

/// Two rods of 1 m and 1 kg in a row, horizontal, hung at the origin and between them.
struct HungRods : EventWorld {
  HungRods(double hz, JointKind kind, const std::string& integrator = "rk4") : EventWorld(hz) {
    settings.integrator = integrator;
    const uint32_t first = add(slim_rod({0.5, 0, 0})), second = add(slim_rod({1.5, 0, 0}));
    join(kind, no_body, first, {});
    join(kind, first, second, {{1, 0, 0}, Quat::Identity()});
  }
};

/// Greatest error of the energy over a minute, relative to its range, 19.62 J.
double energy_error(double hz, const std::string& integrator = "rk4") {
  HungRods w(hz, JointKind::spherical, integrator);
  double worst = 0;
  const int ticks = int(60 * hz + 0.5);
  for (int i = 0; i < ticks; ++i) {
    w.step();
    worst = std::max(worst, std::fabs(w.energy()) / 19.62);
    CHECK(w.joint_error() < 1e-12);
  }
  return worst;
}

}  // namespace

TEST_CASE("a double pendulum under the event stepper keeps its energy for a minute") {
  const double coarse = energy_error(240), fine = energy_error(480);
  const double adaptive = energy_error(240, "rk45");
  MESSAGE("energy error at 1/240, 1/480 and adaptive: " << coarse << " " << fine << " "
                                                        << adaptive);
  CHECK(coarse < 2e-5);
  CHECK(fine < 1e-6);
  CHECK(adaptive < 1e-6);
}

TEST_CASE("jointed bodies move with the fourth order under the event stepper") {
  const auto end = [](double hz) {
    HungRods w(hz, JointKind::revolute);
    w.run(2);
    return w.bodies[1].pose.x;
  };
  const Vec3 coarse = end(500), middle = end(1000), fine = end(2000);
  const double order = std::log2((coarse - middle).norm() / (middle - fine).norm());
  MESSAGE("order " << order);
  CHECK(order > 3.7);
  CHECK(order < 4.4);
}
