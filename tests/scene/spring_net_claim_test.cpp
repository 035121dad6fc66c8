// The scene spring_net. References: the net's rest as the least of its energy, found here by
// Newton's method with a line search from the springs' lengths alone (force left below 1e-11 N);
// the balance of the books. And the particles of scenes/README.md: the energy that there is to fall
// for.
#include "engine/math/dense.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/scene/shipped_scene.hpp"
#include "tests/support/dense.hpp"

#include <algorithm>
#include <vector>

using namespace tumble;
using namespace tumble::test;

namespace {

struct Tie {
  int a, b;     ///< knots; b < 0: the world
  Vec3 anchor;  ///< of the world [m]
  double stiffness, length;
};

/// Knots on springs, under their weight.
struct Net {
  std::vector<Vec3> x;
  std::vector<Tie> ties;
  double mass = 0.02, gravity = 9.81;

  Net() {
    for (int z = 0; z < 9; ++z)
      for (int i = 0; i < 9; ++i) x.push_back({0.15 * (i - 4), 1.3, 0.15 * (z - 4)});
    for (int k = 0; k < 81; ++k) {
      if (k % 9 < 8) ties.push_back({k, k + 1, Vec3::Zero(), 400, 0.15});
      if (k < 72) ties.push_back({k, k + 9, Vec3::Zero(), 400, 0.15});
    }
    for (const int corner : {0, 8, 72, 80}) {
      const Vec3 at(corner % 9 ? 0.85 : -0.85, 1.3, corner > 8 ? 0.85 : -0.85);
      ties.push_back({corner, -1, at, 1500, (at - x[size_t(corner)]).norm()});
    }
  }
  Vec3 end(const Tie& t) const { return t.b < 0 ? t.anchor : x[size_t(t.b)]; }
  double energy() const {
    double sum = 0;
    for (const Vec3& p : x) sum += mass * gravity * p.y();
    for (const Tie& t : ties) {
      const double stretch = (end(t) - x[size_t(t.a)]).norm() - t.length;
      sum += 0.5 * t.stiffness * stretch * stretch;
    }
    return sum;
  }
  /// One step of Newton's method on the energy; slack springs count with their stiffness along
  /// them only, so that the matrix stays definite. Returns the greatest force left before it.
  double step() {
    const Eigen::Index n = Eigen::Index(3 * x.size());
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd matrix = 1e-9 * Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index i = 1; i < n; i += 3) slope[i] += mass * gravity;
    for (const Tie& t : ties) {
      const Vec3 d = end(t) - x[size_t(t.a)];
      const double length = d.norm(), across = std::max(0.0, 1 - t.length / length);
      const Vec3 u = d / length, pull = t.stiffness * (length - t.length) * u;
      const Mat3 K =
          t.stiffness * (u * u.transpose() + across * (Mat3::Identity() - u * u.transpose()));
      slope.segment<3>(3 * t.a) -= dense(pull);
      matrix.block<3, 3>(3 * t.a, 3 * t.a) += dense(K);
      if (t.b < 0) continue;
      slope.segment<3>(3 * t.b) += dense(pull);
      matrix.block<3, 3>(3 * t.b, 3 * t.b) += dense(K);
      matrix.block<3, 3>(3 * t.a, 3 * t.b) -= dense(K);
      matrix.block<3, 3>(3 * t.b, 3 * t.a) -= dense(K);
    }
    const Eigen::VectorXd move = solve_symmetric(matrix, -slope);
    const std::vector<Vec3> before = x;
    const double from = energy();
    double part = std::min(1.0, 0.2 / move.cwiseAbs().maxCoeff());
    for (int k = 0; k < 40; ++k, part *= 0.5) {
      for (size_t i = 0; i < x.size(); ++i)
        x[i] = before[i] + part * small_vector(move.segment<3>(Eigen::Index(3 * i)));
      if (energy() <= from + 1e-15) break;
    }
    return slope.cwiseAbs().maxCoeff();
  }
  void rest() {
    double left = 1;
    for (int k = 0; k < 2000 && left > 1e-12; ++k) left = step();
    MESSAGE("force left ", left, " N");
    REQUIRE(left < 1e-11);
  }
};

const ParticleSystem& net_of(const BuiltScene& s) {
  return *s.world->particles(s.particles.at("net"));
}

}  // namespace

TEST_CASE("spring_net: it comes to rest where its energy is least, and the books close") {
  Net exact;
  exact.rest();
  BuiltScene s = shipped("spring_net", {"parameters.air=5"});
  REQUIRE(net_of(s).size() == 81);
  run(s, 12);
  double worst = 0, sag = 0;
  for (size_t i = 0; i < 81; ++i) {
    worst = std::max(worst, (net_of(s).x[i] - exact.x[i]).norm());
    sag = std::max(sag, 1.3 - exact.x[i].y());
  }
  MESSAGE("sags by ", sag, " m, error ", worst, " m");
  CHECK(sag > 0.1);
  CHECK(worst < 1e-9);
  CHECK(s.world->frame()->ledger->drift() < 1e-5);
}

TEST_CASE("the lump of dust of the README meets the ground and gains hardly any energy" *
          doctest::test_suite("long")) {
  const std::string path = std::string(TUMBLE_SOURCE_DIR) + "/tests/inputs/readme_dust.json";
  const SceneRead read = read_scene(file_text(path), path);
  REQUIRE_MESSAGE(read.ok(), all_text(read.faults));
  auto built = build_world(read.scene);
  REQUIRE(built.ok());
  const double start = built->world->frame()->stats.energies.total();
  double least = start;
  CHECK(start > 100);
  while (built->world->time() < 0.9) {
    REQUIRE(built->world->step().ok());
    const double now = built->world->frame()->stats.energies.total();
    CHECK(now < least + 0.03 * start);
    least = std::min(least, now);
  }
  CHECK(least < 0.6 * start);  // it has landed
}
