// Forces of resting contacts. References: statics (closed forms of the forces under a table, least
// norm by Lagrange's multipliers), Coulomb's law.
#include "engine/dynamics/contact/exact/contact_forces.hpp"

#include "engine/math/rotation.hpp"
#include "tests/dynamics/rigid_world.hpp"

#include <array>
#include <cmath>

using namespace tumble;

namespace {

constexpr double g = 9.81;

/// A body of 4 kg on four legs at (+-a, -h, +-b) from the middle of the table, its centre of mass
/// at (x, z) from there.
struct Table {
  double a = 0.6, b = 0.4, h = 0.7, x = 0, z = 0, friction = 0;
  Vec3 pull = Vec3::Zero();  ///< a force at the height of the feet, so that nothing tips [N]

  std::vector<ForcePoint> points() const {
    std::vector<ForcePoint> out;
    for (const double i : {-a, a})
      for (const double k : {-b, b}) {
        ForcePoint p;
        p.b = 0;
        p.arm_b = {i - x, -h, k - z};
        p.friction = friction;
        out.push_back(p);
      }
    return out;
  }
  DofBlock free() const {
    DofBlock block;
    block.inverse_mass = 0.25;
    block.inverse_inertia = Vec3(1.5, 0.8, 2.0).cwiseInverse().asDiagonal();
    block.v = Vec3(0, -g, 0) + 0.25 * pull;
    block.omega = block.inverse_inertia * Vec3(-x, -h, -z).cross(pull);
    return block;
  }
};

struct Answer {
  ContactForceReport report;
  std::vector<Vec3> forces;
  DofBlock block;
};

Answer solve(const Table& table, std::string_view solver, std::string_view cone = "circular",
             bool least = false) {
  Answer out;
  std::vector<DofBlock> blocks{table.free()};
  auto method = contact_force_method(solver, cone);
  REQUIRE(method.ok());
  method->least = least;
  out.report = solve_contact_forces(blocks, table.points(), *method, out.forces);
  out.block = blocks[0];
  return out;
}

}  // namespace

TEST_CASE("contact forces: under a table they are those of least norm, and have its symmetry") {
  for (const double friction : {0.0, 0.5}) {
    for (const auto& [x, z] : {std::pair{0.0, 0.0}, {0.2, 0.0}, {-0.15, 0.1}}) {
      Table t;
      t.friction = friction, t.x = x, t.z = z;
      const Answer found = solve(t, "automatic", "circular", true);
      REQUIRE(found.report.solved);
      // Sum, and moments about the middle, given: the least squares are linear in the position.
      size_t k = 0;
      for (const double i : {-t.a, t.a})
        for (const double l : {-t.b, t.b}) {
          const double want = g * (1 + x * i / (t.a * t.a) + z * l / (t.b * t.b));
          CAPTURE(k);
          CHECK((found.forces[k++] - Vec3(0, want, 0)).norm() < 1e-9 * g);
        }
    }
  }
}

TEST_CASE("contact forces: every solver holds the table, and the report names who answered") {
  Table t;
  t.x = 0.1, t.friction = 0.5, t.pull = {9, 0, 7};
  for (const lcp::LcpSolverEntry& entry : lcp::all_lcp_solvers()) {
    CAPTURE(entry.name);
    const Answer found = solve(t, entry.name);
    REQUIRE(found.report.solved);
    CHECK(found.block.v.norm() < 1e-7);
    CHECK(found.block.omega.norm() < 1e-7);
    Vec3 sum = t.pull;
    for (const Vec3& f : found.forces) {
      sum += f;
      CHECK(std::hypot(f.x(), f.z()) <= 0.5 * f.y() * (1 + 1e-7));
    }
    CHECK((sum - Vec3(0, 4 * g, 0)).norm() < 1e-7 * 4 * g);
    CHECK(found.report.substituted == (found.report.solver != entry.name));
    CHECK_FALSE((entry.undecided && found.report.substituted));
  }
}

TEST_CASE("contact forces: a pyramid holds more along its diagonal than the cone, as it must") {
  // Feet at the centre's height: nothing tips, and the limit is friction times the weight.
  for (const double angle_deg : {0.0, 20.0, 45.0, 70.0}) {
    for (const double share : {0.999, 1.001}) {
      Table t;
      t.h = 0, t.friction = 0.5;
      Vec3 t1, t2;
      tangent_frame(Vec3::UnitY(), t1, t2);
      const double angle = angle_deg * 3.14159265358979323846 / 180;
      const Vec3 along = std::cos(angle) * t1 + std::sin(angle) * t2;
      const double cone = 0.5 * 4 * g;
      const double pyramid = cone / std::max(std::fabs(along.dot(t1)), std::fabs(along.dot(t2)));
      for (const auto& [name, limit] : {std::pair{std::string_view("circular"), cone},
                                        {std::string_view("pyramid"), pyramid}}) {
        CAPTURE(name);
        CAPTURE(angle_deg);
        t.pull = share * limit * along;
        const Answer found = solve(t, "automatic", name);
        REQUIRE(found.report.solved);
        CHECK((found.block.v.norm() > 1e-6) == (share > 1));
      }
    }
  }
}

TEST_CASE("contact forces: unknown names are refused with the nearest known one") {
  const auto solver = contact_force_method("dantzigg", "circular");
  REQUIRE_FALSE(solver.ok());
  CHECK(solver.error().text().find("dantzig") != std::string::npos);
  const auto cone = contact_force_method("baraff", "circle");
  REQUIRE_FALSE(cone.ok());
  CHECK(cone.error().text().find("circular") != std::string::npos);
}
