#pragma once
// A world of rigid bodies only under the stages of the realtime tick, for tests that look at the
// stages themselves.
#include "engine/core/hash.hpp"
#include "engine/dynamics/realtime/tick.hpp"
#include "tests/support/why_not.hpp"

#include <cstdlib>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include <doctest/doctest.h>

namespace tumble::test {

inline ShapeDef sphere(double radius) {
  ShapeDef s;
  s.type = ShapeType::sphere;
  s.radius = radius;
  return s;
}
inline ShapeDef box(double x, double y, double z) {
  ShapeDef s;
  s.type = ShapeType::box;
  s.half_extents = {x, y, z};
  return s;
}
inline ShapeDef capsule(double radius, double height) {
  ShapeDef s;
  s.type = ShapeType::capsule;
  s.radius = radius;
  s.height = height;
  return s;
}
inline ShapeDef ellipsoid(const Vec3& semi_axes) {
  ShapeDef s;
  s.type = ShapeType::ellipsoid;
  s.half_extents = semi_axes;
  return s;
}
inline ShapeDef cylinder(double radius, double height) {
  ShapeDef s = capsule(radius, height);
  s.type = ShapeType::cylinder;
  return s;
}
inline ShapeDef half_space() {
  ShapeDef s;
  s.type = ShapeType::half_space;
  return s;
}
inline ShapeDef hull(TriangleMesh mesh) {
  ShapeDef s;
  s.type = ShapeType::convex_hull;
  s.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  return s;
}
inline ShapeDef mesh(TriangleMesh triangles) {
  ShapeDef s = hull(std::move(triangles));
  s.type = ShapeType::triangle_mesh;
  return s;
}

inline BodyDef body(ShapeDef shape, const Vec3& x, double friction = 0.5, double restitution = 0) {
  BodyDef d;
  d.pose.x = x;
  d.shapes.emplace_back();
  d.shapes[0].shape = std::move(shape);
  d.shapes[0].material.friction = friction;
  d.shapes[0].material.restitution = restitution;
  return d;
}

/// Bodies by slot, and short ways to add them.
class BodyList {
 public:
  uint32_t add(const BodyDef& def) {
    Result<RigidBody> made = make_body(def);
    REQUIRE_MESSAGE(made.ok(), test::why_not(made));
    bodies.push_back(*made);
    return uint32_t(bodies.size() - 1);
  }
  uint32_t fixed(ShapeDef shape, const Vec3& x = Vec3::Zero(), double friction = 0.5,
                 double restitution = 0) {
    BodyDef d = body(std::move(shape), x, friction, restitution);
    d.type = BodyType::fixed;
    return add(d);
  }
  /// The floor y <= 0.
  uint32_t floor(double friction = 0.5, double restitution = 0) {
    return fixed(half_space(), Vec3::Zero(), friction, restitution);
  }

  std::vector<RigidBody> bodies;
};

class RigidWorld : public BodyList {
 public:
  explicit RigidWorld(double hz = 60, int threads = 1,
                      std::string_view broad_phase = "uniform_grid")
      : h(1 / hz), crew(threads) {
    for (const BroadPhaseEntry& e : all_broad_phases()) {
      if (e.name != broad_phase) continue;
      broad = e.make();
      path_broad = e.make();
    }
    REQUIRE(broad);
  }

  void step() {
    if (before_step) before_step();
    RealtimeTick now = tick();
    const Status done = now.run();
    REQUIRE_MESSAGE(done.ok(), test::why_not(done));
    solve_stats = now.report.solve;
    ++ticks;
  }
  /// A tick from the bodies as they are now: tests change them at will. Its stages may be called
  /// one by one.
  RealtimeTick tick() {
    apart = {};
    for (const Joint& j : joints)
      if (!j.collide && j.a != no_body) apart.add(j.a, j.b);
    apart.sort();
    roster.forget();
    roster.refresh(bodies);
    return {.settings = settings,
            .gravity = gravity,
            .h = h,
            .broad_phase = *broad,
            .path_broad_phase = *path_broad,
            .continuous_methods = continuous_methods,
            .narrow_phase = &collide,
            .hierarchy = nullptr,
            .bodies = bodies,
            .joints = joints,
            .couplings = couplings,
            .links = links,
            .apart = apart,
            .roster = roster,
            .proxies = proxies,
            .pairs = pairs,
            .contacts = contacts,
            .islands = islands,
            .solver = solver,
            .continuous = continuous,
            .sleep_scratch = sleep_scratch,
            .crew = crew,
            .profiler = profiler,
            .listener = listener};
  }
  /// Contacts of a tick, without its motion.
  void find_contacts() {
    RealtimeTick now = tick();
    CHECK(now.find_pairs(h).ok());
    now.find_contacts(h, settings);
  }
  void run(double seconds) {
    const int n = int(seconds / h + 0.5);
    for (int i = 0; i < n; ++i) step();
  }

  double kinetic_energy() const {
    double e = 0;
    for (const RigidBody& b : bodies) e += b.kinetic_energy();
    return e;
  }
  Vec3 momentum() const {
    Vec3 p = Vec3::Zero();
    for (const RigidBody& b : bodies) p += b.mass * b.v;
    return p;
  }
  size_t awake() const {
    size_t n = 0;
    for (const RigidBody& b : bodies) n += b.dynamic() && !b.asleep;
    return n;
  }
  /// Hash of everything that a later step reads.
  uint64_t hash() const {
    ByteWriter out;
    for (const RigidBody& b : bodies) {
      out.raw(b.pose.x.data(), 24);
      out.raw(b.pose.q.coeffs().data(), 32);
      out.raw(b.v.data(), 24);
      out.raw(b.omega.data(), 24);
      out.raw(b.rest.v.data(), 24);
      out.raw(b.rest.omega.data(), 24);
      out.value(b.rest.time);
      out.value(b.asleep);
    }
    contacts.save(out);
    return hash_bytes(out.bytes());
  }

  double h;
  Vec3 gravity{0, -9.81, 0};
  RealtimeSettings settings;
  std::vector<BodyLink> links;
  std::vector<Joint> joints;
  std::vector<JointCoupling> couplings;
  PairFilter apart;
  ContactSet contacts;
  IslandSet islands;
  SleepScratch sleep_scratch;
  ProxySet proxies;
  std::vector<ProxyPair> pairs;
  std::unique_ptr<BroadPhase> broad, path_broad;
  Roster roster;
  RealtimeSolver solver;
  ContinuousStage continuous;
  Crew crew;
  std::function<void()> before_step;
  ContinuousMethods continuous_methods;
  Profiler profiler;
  TickListener listener;
  RealtimeSolveStats solve_stats;
  uint64_t ticks = 0;
};

}  // namespace tumble::test
