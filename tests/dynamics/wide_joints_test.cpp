// Joints in bundles. References: the scalar rows in double precision, row for row in the
// order of the colours; conservation of momentum; the same bytes for every instruction set and
// number of threads.
#include "engine/dynamics/realtime/integrate_bodies.hpp"
#include "engine/dynamics/realtime/solve_joints.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/dynamics/realtime/wide/wide_island.hpp"
#include "tests/dynamics/joint_world.hpp"
#include "tests/dynamics/piles.hpp"

#include <algorithm>

#include <hwy/targets.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Bodies in a cubic lattice, most neighbours joined at random frames; some bodies are fixed.
struct Net : JointWorld {
  explicit Net(int side, uint64_t seed = 1, bool hung = true, int worker_threads = 1)
      : threads(worker_threads) {
    Random r(seed);
    for (int i = 0; i < side * side * side; ++i) add(node(r, place(i, side), hung && i % 23 == 0));
    for (int i = 0; i < side * side * side; ++i) {
      int step = 1;
      for (int axis = 0; axis < 3; ++axis, step *= side)
        if (i / step % side + 1 < side && r.uniform(0, 1) < 0.7) tie(r, i, i + step);
    }
    for (RigidBody& b : bodies) b.shapes.clear();  // nothing collides
  }

  static Vec3 place(int i, int side) {
    return {double(i % side), double(i / side % side), double(i / side / side)};
  }
  static BodyDef node(Random& r, const Vec3& x, bool is_fixed) {
    const double size = r.uniform(0.2, 0.4);
    BodyDef d = body(r.uniform(0, 1) < 0.3 ? sphere(size) : box(size, 0.3, 0.25), x);
    d.pose.q = Quat(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
    d.pose.q.normalize();
    if (is_fixed) d.type = BodyType::fixed;
    d.velocity = {r.uniform(-2, 2), r.uniform(-2, 2), r.uniform(-2, 2)};
    d.angular_velocity = {r.uniform(-4, 4), r.uniform(-4, 4), r.uniform(-4, 4)};
    return d;
  }
  void tie(Random& r, int i, int k) {
    const auto a = uint32_t(i), b = uint32_t(k);
    if (!bodies[a].dynamic() && !bodies[b].dynamic()) return;
    Pose at{0.5 * (bodies[a].pose.x + bodies[b].pose.x), bodies[a].pose.q};
    join(r.uniform(0, 1) < 0.4 ? JointKind::revolute : JointKind::spherical, a, b, at);
    // Slightly off, so that there is something to work off.
    joints.back().frame_b.x += Vec3(r.uniform(-.01, .01), r.uniform(-.01, .01), 0);
  }
  bool tied(uint32_t body) const {
    return std::any_of(joints.begin(), joints.end(),
                       [&](const Joint& j) { return j.a == body || j.b == body; });
  }
  SolverContext context() { return {bodies, contacts.contacts(), gravity, h, &settings, joints}; }
  SolveResiduals wide_tick() {
    build_islands(bodies, contacts, links, h, islands);
    std::vector<uint32_t> which;
    for (uint32_t k = 0; k < islands.islands.size(); ++k)
      if (islands.islands[k].joint_begin < islands.islands[k].joint_end) which.push_back(k);
    Crew workers(threads);
    plans.make(context(), islands, workers);  // of which only the traits count
    wide.lay_out(context(), islands, which, plans.traits(), WideSort::joints, workers);
    return wide.solve(context(), workers);
  }

  int threads;
  SolvePlans plans;
  WideIsland wide;
};

/// One tick of all joints by the scalar rows, in the order of the colours.
void scalar_tick(Net& w) {
  build_islands(w.bodies, w.contacts, w.links, w.h, w.islands);
  std::vector<ColourEdge> edges;
  for (const uint32_t k : w.islands.joints) {
    const auto end = [&](uint32_t slot) {
      return w.bodies[slot].dynamic() ? slot : ColourEdge::fixed;
    };
    edges.push_back({end(w.joints[k].a), end(w.joints[k].b)});
  }
  Colouring colouring;
  colouring.assign(edges, uint32_t(w.bodies.size()));
  std::vector<JointBlock> blocks;
  std::vector<DriveRow> drives;
  for (uint32_t colour = 0; colour < colouring.colours(); ++colour)
    for (const uint32_t edge : colouring.of(colour)) {
      JointBlock& block = blocks.emplace_back();
      block.source = w.islands.joints[edge];
      block.a = w.joints[block.source].a;
      block.b = w.joints[block.source].b;
      add_drives(w.joints[block.source], 0, block, drives);
    }
  std::vector<SolverBody> bodies(w.bodies.size());
  std::vector<SolverMotion> motions(w.bodies.size());
  for (uint32_t k = 0; k < bodies.size(); ++k) {
    if (w.bodies[k].type != BodyType::fixed) motions[k].slot = k;
    motions[k].jointed = true;
  }
  const SolverContext context = w.context();
  const double hs = w.h / w.settings.substeps;
  SolverIsland all{bodies, motions, {}, {}, blocks, tolerances::ordinary_joint_sweeps};
  all.joint_softness = {joint_softness(hs).bias_rate};
  prepare_rows(context, all, hs);
  prepare_joints(context, all, hs);
  for (int i = 0; i < w.settings.substeps; ++i) {
    integrate_velocities(context, all, 0.5 * hs);
    warm_start_joints(all, hs, JointPass::moving);
    for (const JointPass pass : {JointPass::moving, JointPass::correcting})
      sweep_joints(all, hs, pass, sweeps_of(pass, tolerances::ordinary_joint_sweeps));
    integrate_positions(context, all, hs);
    integrate_velocities(context, all, 0.5 * hs);
    refresh_joints(context, all, hs);
    warm_start_joints(all, hs, JointPass::relaxing);
    relax_joints(all, hs);
  }
  store_joints(context, all, hs);
  store_bodies(context, all);
}

std::vector<uint64_t> net_hashes(int threads, int side, int ticks) {
  Net w(side, 7, true, threads);
  std::vector<uint64_t> out;
  for (int k = 0; k < ticks; ++k) {
    w.wide_tick();
    out.push_back(w.hash());
  }
  return out;
}

}  // namespace

TEST_CASE("a tick of bundled joints is that of the scalar rows in the same order") {
  double force = 0, velocity = 0, turning = 0, place = 0;
  for (int round = 0; round < scaled(12, 3); ++round) {
    Net w(5, uint64_t(round) + 1), other(5, uint64_t(round) + 1);
    for (int k = 0; k < 10 * (round % 3); ++k) w.wide_tick();
    for (RigidBody& b : w.bodies)  // what spins faster is integrated otherwise
      if (b.omega.norm() > 6) b.omega *= 6 / b.omega.norm();
    other.bodies = w.bodies;
    other.joints = w.joints;
    w.wide_tick();
    scalar_tick(other);
    REQUIRE(w.wide.joints() == w.joints.size());
    double strongest = 0;
    for (const Joint& j : other.joints)
      strongest =
          std::max(strongest, Vec3(j.moving_force[0], j.moving_force[1], j.moving_force[2]).norm());
    for (size_t k = 0; k < w.joints.size(); ++k)
      for (size_t i = 0; i < JointRows::most; ++i)
        force = std::max(
            {force,
             std::fabs(w.joints[k].moving_force[i] - other.joints[k].moving_force[i]) / strongest,
             std::fabs(w.joints[k].relaxing_force[i] - other.joints[k].relaxing_force[i]) /
                 strongest});
    for (size_t k = 0; k < w.bodies.size(); ++k) {
      const RigidBody &x = w.bodies[k], &y = other.bodies[k];
      if (!w.tied(uint32_t(k))) continue;  // the scalar tick moves it, no island does
      velocity = std::max(velocity, (x.v - y.v).norm());
      turning = std::max(turning, (x.omega - y.omega).norm());
      place = std::max({place, (x.pose.x - y.pose.x).norm(), x.pose.q.angularDistance(y.pose.q)});
    }
  }
  MESSAGE("force " << force << " velocity " << velocity << " turning " << turning << " place "
                   << place);
  // Speeds are up to 5 m/s and 10 rad/s.
  CHECK(force < 5e-5);
  CHECK(velocity < 5e-5);
  CHECK(turning < 5e-4);
  CHECK(place < 5e-6);
}

TEST_CASE("bundled joints conserve momentum") {
  Net w(6, 3, false);
  w.gravity.setZero();
  const Vec3 before = w.momentum();
  double sum = 0;
  for (const RigidBody& b : w.bodies) sum += b.mass * b.v.norm();
  for (int k = 0; k < 60; ++k) {
    w.wide_tick();
    CHECK((w.momentum() - before).norm() < 1e-6 * sum);
  }
}

TEST_CASE("a net that hangs in bundled joints loses energy and keeps its joints") {
  Net w(8);
  for (RigidBody& b : w.bodies) b.v = b.omega = Vec3::Zero();
  const double start = w.energy();
  double residual = 0;
  for (int k = 0; k < 240; ++k) {
    residual = std::max(residual, w.wide_tick().joints);
    CHECK(w.energy() < start + 1e-3 * std::fabs(start));
  }
  MESSAGE("gap " << w.joint_error() << " residual " << residual);
  CHECK(w.joint_error() < 0.1);
}

TEST_CASE("other kinds of joints are solved beside the bundles") {
  JointWorld w;
  w.settings.max_substeps = w.settings.substeps;  // as in ordinary ones
  uint32_t last = no_body;
  const std::array kinds{JointKind::spherical, JointKind::universal, JointKind::revolute,
                         JointKind::rigid};
  for (int i = 0; i < 12; ++i) {
    BodyDef d = body(box(0.1, 0.04, 0.05), {0.2 * i + 0.1, 0, 0});
    const uint32_t next = w.add(d);
    w.join(kinds[size_t(i) % 4], last, next, frame_along({0.2 * i, 0, 0}, {0, 0, 1}, {1, 0, 0}));
    last = next;
  }
  const double start = w.energy();
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    w.step();
    worst = std::max(worst, w.joint_error());
  }
  MESSAGE("gap " << worst);
  CHECK(worst < 0.1);
  CHECK(w.energy() < start + 0.1);
}

TEST_CASE("bundled joints give the same bits for every instruction set") {
  const int ticks = scaled(60, 12);
  const std::vector<uint64_t> best = net_hashes(1, 5, ticks);
  for (int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    const int64_t target = left & -left;
    CAPTURE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    CHECK(net_hashes(1, 5, ticks) == best);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

TEST_CASE("bundled joints give the same bits on 1 to 8 threads") {
  const std::vector<uint64_t> one = net_hashes(1, 11, 6);
  for (int threads = 2; threads <= 8; ++threads) CHECK(net_hashes(threads, 11, 6) == one);
}
