// Forces of resting contacts. References: statics (closed forms of the forces under a table, least
// norm by Lagrange's multipliers), Coulomb's law.
#include "engine/dynamics/event/contact_forces.hpp"

#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/rigid_world.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/scale.hpp"

#include <array>
#include <cmath>

using namespace tumble;
using namespace tumble::test;

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

/// A lattice of balls without friction on a floor, a little disordered, all of which may touch
/// their neighbours; every so often one does not.
struct Heap {
  std::vector<DofBlock> blocks;
  std::vector<ForcePoint> points;

  Heap(uint64_t side, uint64_t seed) {
    Random random(seed);
    std::vector<Vec3> centres;
    const auto at = [&](uint64_t i, uint64_t j, uint64_t k) {
      return uint32_t((k * side + i) * side + j);
    };
    for (uint64_t k = 0; k < side; ++k)
      for (uint64_t i = 0; i < side; ++i)
        for (uint64_t j = 0; j < side; ++j) {
          centres.push_back(Vec3(double(i), double(k), double(j)) +
                            0.1 * Vec3(random.uniform(-1, 1), 0, random.uniform(-1, 1)));
          DofBlock b;
          b.inverse_mass = 1;
          b.inverse_inertia = 10 * Mat3::Identity();
          b.v = {0, -g, 0};
          blocks.push_back(b);
        }
    const auto touch = [&](uint32_t a, uint32_t b) {
      if (random.uniform(0, 1) < 0.1) return;
      ForcePoint p;
      p.a = a, p.b = b;
      const Vec3 between = centres[b] - centres[a];
      p.normal = between.normalized();
      p.arm_a = 0.5 * between, p.arm_b = -0.5 * between;
      p.bias = random.uniform(0, 2);
      points.push_back(p);
    };
    for (uint64_t k = 0; k < side; ++k)
      for (uint64_t i = 0; i < side; ++i)
        for (uint64_t j = 0; j < side; ++j) {
          const uint32_t own = at(i, j, k);
          if (i + 1 < side) touch(own, at(i + 1, j, k));
          if (j + 1 < side) touch(own, at(i, j + 1, k));
          if (k + 1 < side) touch(own, at(i, j, k + 1));
          if (k > 0) continue;
          ForcePoint p;
          p.b = own;
          p.arm_b = {0, -0.5, 0};
          points.push_back(p);
        }
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
        const auto& shown_name = name;
        CAPTURE(shown_name);
        CAPTURE(angle_deg);
        t.pull = share * limit * along;
        const Answer found = solve(t, "automatic", name);
        REQUIRE(found.report.solved);
        CHECK((found.block.v.norm() > 1e-6) == (share > 1));
      }
    }
  }
}

TEST_CASE("contact forces: many points without friction, body by body, as by pivots") {
  for (const uint64_t side : {3u, 4u, 6u})
    for (uint64_t seed = 1; seed <= 4; ++seed) {
      CAPTURE(side);
      CAPTURE(seed);
      const Heap heap(side, seed);
      std::vector<DofBlock> by_blocks = heap.blocks, by_pivots = heap.blocks;
      std::vector<Vec3> forces, reference;
      const ContactForceReport found = solve_contact_forces(by_blocks, heap.points, {}, forces);
      const auto pivots = contact_force_method("dantzig", "circular");
      REQUIRE(pivots.ok());
      REQUIRE(solve_contact_forces(by_pivots, heap.points, *pivots, reference).solved);
      REQUIRE(found.solved);
      CHECK(found.solver == (heap.points.size() > 60 ? "cone_newton" : "dantzig"));
      for (size_t i = 0; i < by_blocks.size(); ++i)
        CHECK((by_blocks[i].v - by_pivots[i].v).norm() < 1e-7 * g);
      // From the answer it is found again at once.
      std::vector<DofBlock> again = heap.blocks;
      const ContactForceReport warm = solve_contact_forces(again, heap.points, {}, forces);
      CHECK(warm.iterations <= found.iterations);
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

namespace {

/// A plate with three or four points that slide along walls in its plane, with random walls,
/// friction and forces.
struct SlidingPoints {
  DofBlock free;
  std::vector<ForcePoint> points;

  explicit SlidingPoints(Random& r) {
    free.inverse_mass = 1;
    free.inverse_inertia = Vec3(1e3, 1e3, r.uniform(1, 6)).asDiagonal();
    free.v = {r.uniform(-5, 5), r.uniform(-5, 5), 0};
    free.omega = {0, 0, r.uniform(-5, 5)};
    const int count = r.uniform() < 0.5 ? 3 : 4;
    for (int i = 0; i < count; ++i) {
      ForcePoint p;
      p.b = 0;
      p.arm_b = {r.uniform(-1, 1), r.uniform(-1, 1), 0};
      const double angle = r.uniform(0, 6.283);
      p.normal = {std::cos(angle), std::sin(angle), 0};
      p.slip = (r.uniform() < 0.5 ? 1 : -1) * Vec3(-p.normal.y(), p.normal.x(), 0);
      p.sliding = true;
      p.friction = r.uniform(0.1, 2);
      points.push_back(p);
    }
  }
  double acceleration(const DofBlock& block, size_t i) const {
    const ForcePoint& p = points[i];
    return p.normal.dot(block.v + block.omega.cross(p.arm_b));
  }
  /// The plate with unit normal force at a point, and the friction that goes with it.
  DofBlock pushed(const DofBlock& block, size_t i, double force) const {
    const ForcePoint& p = points[i];
    const Vec3 push = force * (p.normal - p.friction * p.slip);
    DofBlock out = block;
    out.v += out.inverse_mass * push;
    out.omega += out.inverse_inertia * p.arm_b.cross(push);
    return out;
  }
  /// How well the best set of pressing points does: the least of all forces and accelerations that
  /// must not be negative, as large as it can be made.
  double best() const {
    const size_t n = points.size();
    Eigen::MatrixXd A(n, n);
    Eigen::VectorXd b(n);
    DofBlock rest = free;
    rest.v.setZero(), rest.omega.setZero();
    for (size_t i = 0; i < n; ++i) {
      b[Eigen::Index(i)] = acceleration(free, i);
      for (size_t j = 0; j < n; ++j)
        A(Eigen::Index(i), Eigen::Index(j)) = acceleration(pushed(rest, j, 1), i);
    }
    double best = -1e300;
    for (unsigned set = 0; set < 1u << n; ++set) {
      std::vector<Eigen::Index> in;
      for (size_t i = 0; i < n; ++i)
        if (set >> i & 1) in.push_back(Eigen::Index(i));
      Eigen::VectorXd f = Eigen::VectorXd::Zero(Eigen::Index(n));
      if (!in.empty()) {
        const Solved some = test::solve(Eigen::MatrixXd(A(in, in)), Eigen::VectorXd(-b(in)));
        if (std::fabs(some.determinant) < 1e-3) continue;
        f(in) = some.x;
      }
      const Eigen::VectorXd w = A * f + b;
      double least = 1e300;
      for (Eigen::Index i = 0; i < f.size(); ++i)
        least = std::min(least, (set >> i & 1) != 0 ? f[i] : w[i]);
      best = std::max(best, least);
    }
    return best;
  }
};

}  // namespace

TEST_CASE("contact forces: sliding forces are found wherever there are any") {
  Random r(31);
  const int draws = test::graded_count(4000, 4000, 200);
  int found = 0, none = 0, substituted = 0;
  for (int k = 0; k < draws; ++k) {
    const SlidingPoints plate(r);
    const double best = plate.best();
    if (std::fabs(best) < 1e-3) continue;
    CAPTURE(k);
    std::vector<DofBlock> blocks{plate.free};
    std::vector<Vec3> forces;
    const ContactForceReport report = solve_contact_forces(blocks, plate.points, {}, forces);
    CHECK(report.solved == (best > 0));
    none += best < 0;
    if (!report.solved) continue;
    ++found;
    substituted += report.substituted;
    for (size_t i = 0; i < plate.points.size(); ++i) {
      const ForcePoint& p = plate.points[i];
      const double normal = p.normal.dot(forces[i]), parts = plate.acceleration(blocks[0], i);
      const double unit = 1 + forces[i].norm();
      CHECK(normal >= -1e-7 * unit);
      CHECK((forces[i] - normal * (p.normal - p.friction * p.slip)).norm() <= 1e-7 * unit);
      CHECK(parts >= -1e-6 * unit);
      CHECK(std::fabs(normal * parts) <= 1e-6 * unit * unit);
    }
  }
  MESSAGE(found << " found, " << substituted << " of them from fast slip, none in " << none);
  CHECK(found > draws / 4);
  CHECK(none > draws / 40);
  if (!test::only_to_run()) CHECK(substituted > 0);
}
