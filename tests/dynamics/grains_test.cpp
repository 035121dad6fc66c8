// Grains: balls that spin, collide, rub, roll and rest. References: closed forms of one ball
// (sliding into rolling, rolling friction, restitution), conserved momenta, the weight of a column,
// and runs of the same heap by other numbers of threads.
#include "engine/core/random.hpp"
#include "engine/dynamics/grains/grain_stage.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr double g = 9.81;

/// Grains of one system, and bodies that stand still or move by themselves.
struct Sandbox {
  HandlePool<ParticleSystemTag> ids;
  std::vector<ParticleSystem> systems;
  BodySet bodies;
  RealtimeSettings settings;
  GrainStage stage;
  GrainTouches touches;
  GrainReport report;
  Vec3 gravity{0, -g, 0};
  double h = 1.0 / 60;
  Crew crew;

  explicit Sandbox(GrainDef def = {0, 0}, double friction = 0.5, double restitution = 0,
                   int threads = 1)
      : crew(threads) {
    ParticleSystemDef d;
    d.name = "sand";
    d.grains = def;
    d.friction = friction;
    d.restitution = restitution;
    REQUIRE(validate(d).ok());
    ids.allocate();
    systems.push_back(make_particle_system(d));
  }
  ParticleSystem& grains() { return systems[0]; }
  size_t add(const Vec3& x, const Vec3& v = Vec3::Zero(), double radius = 0.01,
             double mass = 0.01) {
    ParticleDef p;
    p.x = x, p.v = v, p.radius = radius, p.mass = mass;
    grains().add(p);
    return grains().size() - 1;
  }
  uint32_t body(BodyDef def) {
    const BodyId id = bodies.ids.allocate();
    auto made = make_body(def);
    REQUIRE(made.ok());
    bodies.bodies.resize(bodies.ids.capacity());
    bodies.bodies[id.index] = std::move(*made);
    return id.index;
  }
  uint32_t ground(double friction = 0.5) {
    BodyDef def;
    def.type = BodyType::fixed;
    def.shapes.push_back({{.type = ShapeType::half_space}, {}, {}});
    def.shapes[0].material.friction = friction;
    return body(def);
  }
  /// One tick; bodies that can move go straight by their velocities.
  void step() {
    std::vector<Pose> start;
    for (RigidBody& b : bodies.bodies) {
      start.push_back(b.pose);
      if (b.type != BodyType::fixed) b.pose.x += h * b.v;
    }
    touches.begin_tick();
    const Status done =
        stage.step({systems, ids, bodies, start, gravity, h, settings, &crew}, touches, report);
    REQUIRE_MESSAGE(done.ok(), test::why_not(done));
  }
  void run(double seconds) {
    for (int n = int(seconds / h + 0.5); n > 0; --n) step();
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (size_t i = 0; i < systems[0].size(); ++i) sum += systems[0].mass[i] * systems[0].v[i];
    return sum;
  }
  Vec3 angular_momentum() const {
    const ParticleSystem& p = systems[0];
    Vec3 sum = Vec3::Zero();
    for (size_t i = 0; i < p.size(); ++i)
      sum += p.x[i].cross(p.mass[i] * p.v[i]) + p.moment(i) * p.spin[i];
    return sum;
  }
  double energy() const {
    const ParticleSystem& p = systems[0];
    double sum = 0;
    for (size_t i = 0; i < p.size(); ++i)
      sum += 0.5 * p.mass[i] * p.v[i].squaredNorm() + 0.5 * p.moment(i) * p.spin[i].squaredNorm();
    return sum;
  }
};

/// A heap of grains of two sizes, poured onto the ground.
void pour(Sandbox& box, int across, int layers) {
  Random random(5);
  for (int y = 0; y < layers; ++y)
    for (int x = 0; x < across; ++x)
      for (int z = 0; z < across; ++z) {
        const double r = random.uniform(0.008, 0.01);
        box.add({0.021 * (x - 0.5 * across) + random.uniform(-1e-3, 1e-3), 0.011 + 0.021 * y,
                 0.021 * (z - 0.5 * across) + random.uniform(-1e-3, 1e-3)},
                Vec3::Zero(), r, 2600 * 4.0 / 3 * std::numbers::pi * r * r * r);
      }
}

}  // namespace

TEST_CASE("a grain slides until it rolls: 5/7 of its speed after 2 v0 / (7 mu g)") {
  for (const double mu : {0.1, 0.3}) {
    Sandbox box({0, 0}, mu);
    box.ground(mu);
    const double v0 = 2, r = 0.01;
    const size_t i = box.add({0, r, 0}, {v0, 0, 0}, r);
    box.run(0.1);  // the load is known
    const double when = 2 * v0 / (7 * mu * g);
    box.run(0.5 * when - 0.1);
    // Halfway v = v0 - mu g t, and the spin is 5/2 mu g t / r.
    const double t = std::round(0.5 * when / box.h) * box.h;
    CHECK(box.grains().v[i].x() == doctest::Approx(v0 - mu * g * t).epsilon(0.01));
    CHECK(box.grains().spin[i].z() == doctest::Approx(-2.5 * mu * g * t / r).epsilon(0.02));
    box.run(when);
    CHECK(box.grains().v[i].x() == doctest::Approx(5.0 / 7 * v0).epsilon(0.005));
    CHECK(box.grains().spin[i].z() == doctest::Approx(-5.0 / 7 * v0 / r).epsilon(0.005));
    // When it stopped sliding shows in how far it came.
    const double end = 5.0 / 7 * v0, s = v0 * when - 0.5 * mu * g * when * when;
    const double passed = std::round(0.1 / box.h) * box.h +
                          std::round((0.5 * when - 0.1) / box.h) * box.h +
                          std::round(when / box.h) * box.h;
    CHECK(box.grains().x[i].x() == doctest::Approx(s + end * (passed - when)).epsilon(0.01));
  }
}

TEST_CASE(
    "a pair of grains rolls to the same rest, however light, and however far from the origin") {
  // Friction and rolling friction of a grain on another: what single precision could lose.
  const auto run = [](double mass, const Vec3& from) {
    Sandbox box({0.1, 0.05}, 0.5);
    box.ground();
    box.settings.sleeping = false;
    for (const double x : {-0.0105, 0.0105}) box.add(from + Vec3(x, 0.01, 0), {}, 0.01, mass);
    box.add(from + Vec3(0.001, 0.028, 0.0005), {0.1, 0, 0}, 0.01, mass);
    box.run(1);
    std::vector<Vec3> places;
    for (const Vec3& x : box.grains().x) places.push_back(x - from);
    return places;
  };
  const std::vector<Vec3> usual = run(0.01, Vec3::Zero());
  const std::vector<Vec3> light = run(1e-18, Vec3::Zero());
  const std::vector<Vec3> far = run(0.01, Vec3(1000, 0, -1000));
  for (size_t i = 0; i < usual.size(); ++i) {
    CHECK((light[i] - usual[i]).norm() < 1e-4 * 0.01);
    CHECK((far[i] - usual[i]).norm() < 1e-4 * 0.01);
  }
}

TEST_CASE("rolling friction slows a rolling grain by 5/7 mu_r g") {
  // m a = f and I a / r = -(f r + mu_r r m g) with I = 2/5 m r^2: 7/5 m a = -mu_r m g.
  for (const double mu_r : {0.02, 0.1}) {
    Sandbox box({mu_r, 0}, 0.8);
    box.ground(0.8);
    const double v0 = 1, r = 0.01;
    const size_t i = box.add({0, r, 0}, {v0, 0, 0}, r);
    box.grains().spin[i] = {0, 0, -v0 / r};
    const double a = 5.0 / 7 * mu_r * g;
    box.run(0.5 * v0 / a);
    const double t = std::round(0.5 * v0 / a / box.h) * box.h;
    CHECK(box.grains().v[i].x() == doctest::Approx(v0 - a * t).epsilon(0.02));
    box.run(v0 / a);
    CHECK(box.grains().v[i].norm() < 1e-6);
    CHECK(box.grains().x[i].x() == doctest::Approx(0.5 * v0 * v0 / a).epsilon(0.03));
  }
}

TEST_CASE("torsional friction stops a grain that spins on its pole") {
  // I alpha = -mu_t r m g.
  const double mu_t = 0.05, r = 0.01;
  Sandbox box({0, mu_t});
  box.ground();
  const size_t i = box.add({0, r, 0}, Vec3::Zero(), r);
  box.grains().spin[i] = {0, 60, 0};
  const double alpha = 2.5 * mu_t * g / r;
  box.run(0.2);
  CHECK(box.grains().spin[i].y() == doctest::Approx(60 - alpha * 0.2).epsilon(0.03));
  box.run(0.6);
  CHECK(box.grains().spin[i].norm() < 1e-6);
}

TEST_CASE("two grains head on part with e times the speed of their approach") {
  for (const double e : {0.0, 0.5, 1.0}) {
    Sandbox box({0, 0}, 0.5, e);
    box.gravity.setZero();
    const size_t a = box.add({-0.1, 0, 0}, {3, 0, 0}, 0.01, 0.02);
    const size_t b = box.add({0.1, 0, 0}, {-1, 0, 0}, 0.01, 0.01);
    box.run(0.5);
    const double mean = (0.02 * 3 - 0.01 * 1) / 0.03;
    CHECK(box.grains().v[a].x() == doctest::Approx(mean - e * 4 / 3).epsilon(1e-6));
    CHECK(box.grains().v[b].x() == doctest::Approx(mean + e * 8 / 3).epsilon(1e-6));
  }
}

TEST_CASE("grains that collide obliquely keep momentum and angular momentum, and gain no energy") {
  Random random(11);
  double spun = 0;
  for (int n = 0; n < 300; ++n) {
    Sandbox box({0.05, 0.05}, 0.6, random.uniform());
    box.gravity.setZero();
    // Beyond two, working off overlap moves places: it keeps momentum, and not angular momentum.
    const int count = n < 250 ? 2 : 6;
    for (int k = 0; k < count; ++k) {
      const Vec3 x{k % 2 - 0.5, random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2)};
      const Vec3 off{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      box.add(0.1 * (1 + k / 2) * x, -0.5 * x + 0.02 * off, 0.012, random.uniform(0.005, 0.02));
    }
    const Vec3 p = box.momentum(), l = box.angular_momentum();
    const double energy = box.energy();
    double all = 0;  // Contacts are solved in single precision.
    for (size_t i = 0; i < box.grains().size(); ++i)
      all += box.grains().mass[i] * box.grains().v[i].norm();
    box.run(1);
    CHECK((box.momentum() - p).norm() < 1e-6 * all);
    if (count == 2) CHECK((box.angular_momentum() - l).norm() < 1e-6 * 0.1 * all);
    CHECK(box.energy() < energy * (1 + 1e-6));
    for (const Vec3& s : box.grains().spin) spun = std::max(spun, s.norm());
  }
  CHECK(spun > 1);
}

TEST_CASE("grains that graze gain no energy, wherever in a tick they meet") {
  // Two smooth balls whose paths pass at 1.9 radii: the second meets the first at .31 of its speed.
  const double radius = 0.01, speed = 1.25;
  int struck = 0;
  for (const double threshold : {0.01, 0.5})
    for (const double e : {0.5, 0.9})
      for (int n = 0; n < 20; ++n) {
        Sandbox box({0, 0}, 0, e);
        box.gravity.setZero();
        box.settings.restitution_threshold = threshold;
        box.add({0, 1, 0}, Vec3::Zero(), radius);
        box.add({0.03 + n * speed * box.h / 20, 1 + 1.9 * radius, 0}, {-speed, 0, 0}, radius);
        const double energy = box.energy();
        box.run(0.2);
        CHECK(box.energy() < energy * (1 + 1e-6));
        struck += box.grains().v[0].norm() > 0.05 * speed;
      }
  CHECK(struck == 80);
}

TEST_CASE("a column of grains weighs on the ground and on each other what stands above") {
  Sandbox box;
  box.settings.sleeping = false;
  box.ground();
  const int count = 12;
  for (int k = 0; k < count; ++k) box.add({0, 0.01 + 0.02 * k, 0});
  box.run(2);
  REQUIRE(box.touches.all().size() == count);
  double on_ground = 0;
  for (const GrainTouch& t : box.touches.all()) {
    if (t.on_body()) on_ground += t.push;
    // The k-th from below, with its lower neighbour: what is above the lower.
    else
      CHECK(t.push == doctest::Approx(0.01 * g * (count - int(t.a & 0xffff))).epsilon(1e-3));
  }
  CHECK(on_ground == doctest::Approx(count * 0.01 * g).epsilon(1e-3));
  for (int k = 0; k < count; ++k)
    CHECK(box.grains().x[size_t(k)].y() == doctest::Approx(0.01 + 0.02 * k).epsilon(0.01));
}

TEST_CASE("a heap comes to rest, sleeps, weighs what it weighs, and wakes where it is touched") {
  Sandbox box({0.1, 0.05});
  box.ground();
  pour(box, 6, 8);
  box.run(5);
  CHECK(!box.report.moved);
  double weight = 0, push = 0, lowest = 1;
  for (size_t i = 0; i < box.grains().size(); ++i) {
    weight += box.grains().mass[i] * g;
    CHECK(box.grains().rest[i].asleep());
    lowest = std::min(lowest, box.grains().x[i].y() - box.grains().radius[i]);
  }
  for (const GrainTouch& t : box.touches.all())
    if (t.on_body()) push += t.push;
  CHECK(push == doctest::Approx(weight).epsilon(0.02));
  CHECK(lowest > -1e-4);
  box.add({0, 0.4, 0}, {0, -1, 0});
  box.run(0.1);
  CHECK(box.report.awake == 1);
  box.run(0.2);
  CHECK(box.report.awake > 1);
  box.run(6);
  CHECK(!box.report.moved);
}

TEST_CASE("grains that lean on one that is gone wake") {
  Sandbox box({0.1, 0.05});
  box.ground();
  for (int k = 0; k < 3; ++k) box.add({0, 0.01 + 0.02 * k, 0});
  box.run(3);
  REQUIRE(!box.report.moved);
  box.grains().remove(std::array<uint8_t, 3>{0, 1, 0});
  box.run(1);
  CHECK(box.grains().x[1].y() < 0.035);
}

TEST_CASE("one, two and four threads give a heap the same bits" * doctest::test_suite("long")) {
  std::vector<Vec3> x, spin;
  for (const int threads : {1, 2, 4}) {
    Sandbox box({0.1, 0.05}, 0.5, 0.2, threads);
    box.ground();
    pour(box, 9, 12);
    box.crew.gather([&] { box.run(0.6); });
    if (threads == 1) x = box.grains().x, spin = box.grains().spin;
    CHECK(box.grains().x == x);
    CHECK(box.grains().spin == spin);
  }
}

TEST_CASE("no grain passes through a thin plate, at rest or moving, however fast") {
  Random random(3);
  int met = 0;
  for (const double plate : {0.0, 20.0}) {
    Sandbox box;
    box.gravity.setZero();
    BodyDef def;
    def.type = BodyType::kinematic;
    def.velocity = {plate, 0, 0};
    ShapeDef thin;
    thin.type = ShapeType::box;
    thin.half_extents = {0.001, 1, 1};
    def.shapes.push_back({thin, {}, {}});
    const uint32_t wall = box.body(def);
    for (int k = 0; k < 100; ++k)
      box.add({random.uniform(0.3, 2), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)},
              {-random.uniform(0, 60), 0, 0});
    for (int n = 0; n < 30; ++n) {
      box.step();
      for (size_t i = 0; i < box.grains().size(); ++i) {
        CHECK(box.grains().x[i].x() > box.bodies.bodies[wall].pose.x.x());
        met += box.grains().v[i].x() > -1e-3 && box.grains().v[i].x() >= plate - 1e-3;
      }
    }
  }
  CHECK(met > 500);
}

TEST_CASE("grains and a free body exchange momentum") {
  Sandbox box({0, 0}, 0.4, 0.3);
  box.gravity.setZero();
  BodyDef def;
  ShapeDef cube;
  cube.type = ShapeType::box;
  cube.half_extents = {0.05, 0.05, 0.05};
  def.shapes.push_back({cube, {}, {}});
  const uint32_t slot = box.body(def);
  Random random(8);
  for (int k = 0; k < 30; ++k)
    box.add({-0.1 - 0.03 * k, random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04)}, {4, 0, 0});
  const RigidBody& b = box.bodies.bodies[slot];
  const Vec3 p = box.momentum();
  box.run(1);
  CHECK(b.v.x() > 0.05);
  CHECK((box.momentum() + b.mass * b.v - p).norm() < 1e-6 * p.norm());
}

TEST_CASE("what grains cannot be is refused with its cure") {
  ParticleSystemDef def;
  def.name = "sand";
  def.grains = GrainDef{-1, 0};
  CHECK(validate(def).error().message == "rolling_friction of grains must be >= 0, got -1");
  def.grains = GrainDef{};
  def.fast = true;
  CHECK(validate(def).error().cure == "leave out \"fast\", or \"grains\"");
  def.fast = false;
  def.collide = false;
  CHECK(!validate(def).ok());
}

TEST_CASE("one fast grain far from a heap changes no bit of it") {
  // It is too fast for one part of a tick if many were so fast; its group along the curve, of which
  // it is the last, is slow on the whole.
  const auto heap = [](bool beside) {
    Sandbox box({0.05, 0.05});
    box.settings.sleeping = false;
    box.ground();
    pour(box, 5, 3);
    REQUIRE(box.grains().size() % 4 == 3);
    const size_t count = box.grains().size();
    box.run(0.5);
    if (beside) box.add({5, 5, 5}, {0.7, 0, 0}, 0.009, 0.008);
    box.run(3 * box.h);
    return std::vector(box.grains().x.begin(), box.grains().x.begin() + std::ptrdiff_t(count));
  };
  CHECK(heap(true) == heap(false));
}

TEST_CASE("grains with the same centre part until they touch, and keep their centre of mass") {
  for (const int count : {2, 3}) {
    Sandbox box;
    box.gravity.setZero();
    for (int k = 0; k < count; ++k) box.add({0.3, 0.2, 0.1}, Vec3::Zero(), 0.01, 0.01 * (k + 1));
    box.run(0.5);
    Vec3 middle = Vec3::Zero();
    double mass = 0;
    for (size_t i = 0; i < size_t(count); ++i) {
      middle += box.grains().mass[i] * box.grains().x[i];
      mass += box.grains().mass[i];
      for (size_t j = 0; j < i; ++j)
        CHECK((box.grains().x[i] - box.grains().x[j]).norm() > 0.99 * 0.02);
    }
    CHECK((middle / mass - Vec3(0.3, 0.2, 0.1)).norm() < 1e-6 * 0.02);
  }
}
