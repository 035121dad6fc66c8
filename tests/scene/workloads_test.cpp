// Reference of the definitions: weighted sums over poses, masses, moments, shapes and joints of
// every workload as an independent program makes them (workload_figures.hpp, twelve digits); for
// the balls of W4 also a second writing of the generator and the layout, bit by bit.
#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/core/stop.hpp"
#include "engine/scene/workloads/run.hpp"
#include "tests/scene/workload_figures.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Weights by which a permutation of bodies, or of joints, shows.
double weight(size_t i) {
  return 1 + double(i % 7);
}

void add_mesh(const TriangleMesh& mesh, const Pose& pose, double k, WorkloadFigures& f) {
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 area = face_area_vector(mesh, t);
    const Vec3 centre = (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3;
    f.area += k * area.norm();
    f.area_centre += k * area.norm() * pose.point(centre);
    f.points += k * area.dot(centre) * pose.direction(centre);
  }
}

void add_shape(const BodyShapeDef& s, const Shape& shape, const Pose& body, size_t place, double k,
               WorkloadFigures& f) {
  const ShapeDef& def = s.shape;
  if (def.type == ShapeType::box)
    f.shapes += k * double(place + 1) * (def.half_extents + s.pose.x + 2 * s.pose.q.vec());
  if (def.type == ShapeType::sphere) f.shapes += k * Vec3(def.radius, 0, 0);
  if (def.type == ShapeType::capsule) f.shapes += k * Vec3(def.radius, 0.5 * def.height, 0);
  if (const auto* hull = dynamic_cast<const ConvexHullShape*>(&shape))
    for (const Vec3& v : hull->polyhedron().vertices) f.points += k * (body * s.pose).point(v);
  if (def.type == ShapeType::triangle_mesh) add_mesh(*def.mesh, body * s.pose, k, f);
}

WorkloadFigures figures_of(const Workload& w) {
  WorkloadFigures f{};
  f.name = w.name;
  f.small = w.small;
  f.steps = w.steps;
  f.bodies = w.bodies.size();
  f.joints = w.joints.size();
  f.moments = f.places = f.shapes = f.points = f.anchors = f.axes = f.area_centre = Vec3::Zero();
  f.turns = Vec4::Zero();
  const std::vector<RigidBody> made = bodies_at_start(w);
  for (size_t i = 0; i < made.size(); ++i) {
    const RigidBody& b = made[i];
    const double k = weight(i);
    if (b.dynamic()) {
      ++f.moving;
      f.mass += b.mass;
      f.moments += k * b.inertia_body.diagonal();
      const Mat3 other = b.inertia_body - Mat3(b.inertia_body.diagonal().asDiagonal());
      CHECK(other.norm() < 1e-11 * b.inertia_body.norm());
    }
    f.places += k * b.pose.x;
    f.turns += k * Vec4(b.pose.q.w(), b.pose.q.x(), b.pose.q.y(), b.pose.q.z());
    for (size_t s = 0; s < b.shapes.size(); ++s)
      add_shape(w.bodies[i].shapes[s], *b.shapes[s].shape, w.bodies[i].pose, s, k, f);
  }
  for (size_t i = 0; i < w.joints.size(); ++i) {
    const WorkloadJoint& j = w.joints[i];
    f.anchors += weight(i) * j.frame.x;
    if (j.kind == JointKind::revolute) f.axes += weight(i) * j.frame.direction(Vec3::UnitZ());
  }
  return f;
}

/// Twelve digits are given; sums of thousands of terms lose some of them.
template <class V>
bool near(const V& a, const V& b, double size) {
  return (a - b).norm() <= 1e-9 * (size + a.norm());
}

}  // namespace

TEST_CASE("workloads are what an independent program makes of their definitions") {
  const auto figures = workload_figures();
  REQUIRE(figures.size() == 2 * all_workloads().size());
  for (size_t i = 0; i < figures.size(); ++i) {
    const WorkloadFigures& want = figures[i];
    if (test::only_to_run() && !want.small) continue;
    const auto& entry = all_workloads()[i % all_workloads().size()];
    const WorkloadFigures got = figures_of(make_workload(entry, want.small));
    CAPTURE(std::string(want.name));
    CAPTURE(want.small);
    CHECK(got.name == want.name);
    CHECK(got.steps == want.steps);
    CHECK(got.bodies == want.bodies);
    CHECK(got.moving == want.moving);
    CHECK(got.joints == want.joints);
    const double n = double(want.bodies);
    CHECK(got.mass == doctest::Approx(want.mass).epsilon(1e-9));
    CHECK(near(got.moments, want.moments, 0));
    CHECK(near(got.places, want.places, n));
    CHECK(near(got.turns, want.turns, n));
    CHECK(near(got.shapes, want.shapes, n));
    CHECK(near(got.points, want.points, n));
    CHECK(near(got.anchors, want.anchors, n));
    CHECK(near(got.axes, want.axes, n));
    CHECK(near(got.area_centre, want.area_centre, want.area));
    CHECK(got.area == doctest::Approx(want.area).epsilon(1e-9));
  }
}

TEST_CASE("the rain of W4 is where the generator puts it") {
  const Workload w = make_workload(all_workloads()[3]);
  REQUIRE(w.bodies.size() == 5005);
  uint64_t s = 777;
  const auto jitter = [&s] {
    s = s * 6364136223846793005u + 1442695040888963407u;
    return -0.02 + 0.04 * (double(s >> 33) * std::ldexp(1.0, -31));
  };
  size_t at = 5, wrong = 0;
  for (int layer = 0; at < w.bodies.size(); ++layer) {
    for (int place = 0; place < 256 && at < w.bodies.size(); ++place, ++at) {
      const double x = (place % 16 - 7.5) * 0.6, z = (place / 16 - 7.5) * 0.6;
      const double dx = jitter(), dy = jitter(), dz = jitter();
      const Vec3 want(x + dx, 0.5 + 0.6 * layer + dy, z + dz);
      if (!(w.bodies[at].pose.x - want).isZero(1e-14)) ++wrong;
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("the sand of W9 is where the generator puts it") {
  const Workload w = make_workload(all_workloads().back());
  REQUIRE(w.particles.size() == 1);
  const auto& sand = w.particles[0].particles;
  REQUIRE(sand.size() == 100000);
  CHECK(w.particles[0].friction == 0.5);
  CHECK(w.particles[0].restitution == 0);
  CHECK(w.particles[0].grains.has_value());
  uint64_t s = 4242;
  const auto draw = [&s](double a, double b) {
    s = s * 6364136223846793005u + 1442695040888963407u;
    return a + (b - a) * (double(s >> 33) * std::ldexp(1.0, -31));
  };
  size_t wrong = 0;
  for (size_t i = 0; i < sand.size(); ++i) {
    const auto row = double(i % 100), column = double(i / 100 % 100), layer = double(i / 10000);
    const double dx = draw(-2e-4, 2e-4), dy = draw(-2e-4, 2e-4), dz = draw(-2e-4, 2e-4);
    const Vec3 want((row - 49.5) * 0.0104 + dx, 0.0055 + 0.0104 * layer + dy,
                    (column - 49.5) * 0.0104 + dz);
    const double r = draw(4.6e-3, 5e-3), mass = 2600 * 4.18879020478639 * r * r * r;
    if (!(sand[i].x - want).isZero(1e-14) || std::abs(sand[i].radius - r) > 1e-16 ||
        std::abs(sand[i].mass - mass) > 1e-13 * mass)
      ++wrong;
  }
  CHECK(wrong == 0);
}

TEST_CASE("particles of a workload are measured as balls of their mass") {
  const Workload w = make_workload(all_workloads().back(), true);
  const auto built = build_workload(w, {});
  REQUIRE(built.ok());
  const std::vector<RigidBody> at = built->states();
  REQUIRE(at.size() == 2005);
  double mass = 0;
  for (size_t i = 5; i < at.size(); ++i) mass += at[i].mass;
  double want = 0;
  for (const ParticleDef& p : w.particles[0].particles) want += p.mass;
  CHECK(mass == doctest::Approx(want).epsilon(1e-12));
  // Places 10.4 mm apart, each 0.2 mm off at most along an axis: no two balls of 5 mm meet.
  CHECK(measure_overlaps(w, at).pairs == 0);
}

TEST_CASE("nothing of a workload sleeps, and its surfaces are those of the definition") {
  for (const WorkloadEntry& entry : all_workloads()) {
    const Workload w = make_workload(entry, true);
    for (const BodyDef& b : w.bodies) {
      CHECK_FALSE(b.can_sleep);
      CHECK(b.gravity_scale == 1);
      for (const BodyShapeDef& s : b.shapes) {
        CHECK(s.material.friction == 0.5);
        CHECK(s.material.restitution == 0);
        CHECK(s.material.density == 1000);
      }
    }
  }
  CHECK(WorldSettings{}.tick == TickRate{60, 1});
  CHECK(WorldSettings{}.gravity.now() == Vec3(0, -9.81, 0));
}

TEST_CASE("small workloads run, measured steps are counted, threads change no bit") {
  for (const WorkloadEntry& entry : all_workloads()) {
    CAPTURE(std::string(entry.name));
    const Workload w = make_workload(entry, true);
    WorkloadOptions options;
    options.steps = 12;
    uint64_t told = 0;
    double last = -1;
    options.each = [&](const StepReport& report, double begin, double seconds) {
      CHECK(report.tick == ++told);
      CHECK(begin > last);
      last = begin + seconds;
    };
    const auto run = run_workload(w, options);
    REQUIRE_MESSAGE(run.ok(), test::why_not(run));
    CHECK(told == 12);
    CHECK(run->steps == 12);
    CHECK(run->workload == entry.name);
    CHECK(run->wall.median <= run->wall.p95);
    CHECK(run->wall.p95 <= run->wall.most);
    CHECK(run->wall.mean > 0);
    CHECK_FALSE(run->stages.empty());
    CHECK(run->end.escaped == 0);
    CHECK(run->end.overlap.deepest < 0.3);
    CHECK(run->end.joint_gap < 0.1);
    CHECK(run->joints == w.joints.size());
    options.threads = 2;
    options.each = nullptr;
    const auto again = run_workload(w, options);
    REQUIRE(again.ok());
    CHECK(again->state_hash == run->state_hash);
  }
}

TEST_CASE("times of steps are summed up by rank") {
  std::vector<double> ms;
  for (int i = 100; i > 0; --i) ms.push_back(i);
  const StepTimes t = step_times(ms);
  CHECK(t.mean == doctest::Approx(50.5));
  CHECK(t.median == 51);
  CHECK(t.p95 == 96);
  CHECK(t.most == 100);
  CHECK(step_times({}).most == 0);
}

TEST_CASE("a run that is stopped ends before the next step is done, and measures nothing") {
  WorkloadOptions options;
  StopFlag stop;
  uint64_t done = 0;
  options.stop = &stop;
  options.each = [&](const StepReport& report, double, double) {
    done = report.tick;
    if (done == 3) stop.request();
  };
  const auto run = run_workload(make_workload(all_workloads()[1], true), options);
  REQUIRE_FALSE(run.ok());
  CHECK(run.error().code == ErrorCode::cancelled);
  CHECK(done == 3);
}
