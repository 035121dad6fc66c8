// What is elsewhere in the world changes nothing here. Reference: the same scene alone, every pose
// and velocity bit by bit, beside 2,000 boxes a kilometre away that fall into heaps, lie in them,
// or sleep; and of what is counted and booked, the sums of what either has alone.
#include "engine/geometry/make_mesh.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/workloads/run.hpp"
#include "engine/scene/workloads/workload.hpp"
#include "engine/world/world.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

enum class CrowdKind { none, awake, asleep, bouncing };
/// Whether the crowd was there first, and has the lower slots.
enum class Order { after, before };

/// Twenty heaps of a hundred boxes, each from boxes a little apart above a floor of their own.
std::vector<BodyDef> crowd_bodies(CrowdKind crowd) {
  if (crowd == CrowdKind::none) return {};
  const auto box = [](const Vec3& half_extents, const Vec3& x) {
    BodyDef def;
    def.shapes.emplace_back();
    def.shapes[0].shape.type = ShapeType::box;
    def.shapes[0].shape.half_extents = half_extents;
    def.pose.x = x;
    return def;
  };
  std::vector<BodyDef> out = {box({100, 1, 100}, {1000, -1, 1000})};
  out[0].type = BodyType::fixed;
  const bool asleep = crowd == CrowdKind::asleep;
  const double pitch = asleep ? 0.5 : 0.42;
  for (int heap = 0; heap < 20; ++heap)
    for (int k = 0; k < 100; ++k) {
      const double shift = asleep ? 0 : 0.03 * (k % 7);
      const Vec3 x = {950 + 5.0 * heap + pitch * (k % 5) + shift,
                      0.2 + (asleep ? 0.4 : 0.45) * (k / 25), 1000 + pitch * (k / 5 % 5) + shift};
      out.push_back(box({0.2, 0.2, 0.2}, x));
      out.back().shapes[0].material.restitution = crowd == CrowdKind::bouncing ? 0.6 : 0;
      out.back().starts_asleep = asleep;
    }
  return out;
}

/// The same as a scene would say it; without a name of its own.
BodyDescription description_of(const BodyDef& def) {
  BodyDescription out;
  out.type = def.type;
  out.placement.position = def.pose.x;
  out.shape.emplace();
  out.shape->kind = shape_kind(def.shapes[0].shape);
  out.material.emplace();
  out.material->restitution = def.shapes[0].material.restitution;
  out.starts_asleep = def.starts_asleep;
  return out;
}

struct Watched {
  std::unique_ptr<World> world;
  std::vector<BodyId> bodies;  ///< without the crowd
};

void add(World& world, const std::vector<BodyDef>& crowd) {
  for (const BodyDef& def : crowd) REQUIRE(world.create_body(def).ok());
}

Watched scene(const std::string& name, CrowdKind crowd, Order order,
              std::vector<std::string> overrides = {}) {
  const std::string file = std::string(TUMBLE_SOURCE_DIR) + "/scenes/" + name + ".json";
  SceneRead read = load_scene(file, {std::move(overrides)});
  REQUIRE(read.ok());
  const std::vector<std::string> own = read.scene.bodies.names();
  const std::vector<BodyDef> others = crowd_bodies(crowd);
  if (order == Order::before) {
    NamedList<BodyDescription> bodies;
    for (const BodyDef& def : others)
      bodies.add("one_of_the_crowd_" + std::to_string(bodies.items.size()), description_of(def));
    for (auto& item : read.scene.bodies.items) bodies.items.push_back(std::move(item));
    read.scene.bodies = std::move(bodies);
  }
  auto built = build_world(read.scene);
  REQUIRE_MESSAGE(built.ok(), test::why_not(built));
  Watched out{std::move(built->world), {}};
  if (order == Order::after) add(*out.world, others);
  for (const auto& [body_name, id] : built->bodies)
    if (!body_name.starts_with("one_of_the_crowd_")) out.bodies.push_back(id);
  REQUIRE(out.bodies.size() >= own.size());
  return out;
}

Watched workload(std::string_view name, CrowdKind crowd, Order order) {
  const auto& all = all_workloads();
  const auto entry = std::ranges::find(all, name, &WorkloadEntry::name);
  REQUIRE(entry != all.end());
  Workload w = make_workload(*entry, true);
  const std::vector<BodyDef> others = crowd_bodies(crowd);
  const size_t first = order == Order::before ? others.size() : 0, own = w.bodies.size();
  if (order == Order::before) w.bodies.insert(w.bodies.begin(), others.begin(), others.end());
  for (WorkloadJoint& j : w.joints) {
    j.a += first;
    j.b += first;
  }
  auto made = build_workload(w, {});
  REQUIRE(made.ok());
  if (order == Order::after) add(*made->world, others);
  const auto begin = made->bodies.begin() + std::ptrdiff_t(first);
  return {std::move(made->world), {begin, begin + std::ptrdiff_t(own)}};
}

/// Rings of wire that spin about their diameters above a floor, among which a paddle turns: by more
/// than their gauge in a tick, which has several parts therefore.
std::vector<BodyDef> fast_rings() {
  std::vector<BodyDef> out(2);
  for (BodyDef& def : out) {
    def.shapes.emplace_back();
    def.shapes[0].shape.type = ShapeType::box;
  }
  out[0].type = BodyType::fixed;
  out[0].shapes[0].shape.half_extents = {5, 1, 5};
  out[0].pose.x = {0, -1, 0};
  out[1].type = BodyType::kinematic;
  out[1].shapes[0].shape.half_extents = {0.5, 0.1, 0.05};
  out[1].pose.x = {0, 0.1, 0};
  out[1].angular_velocity = {0, 3, 0};
  const auto wire = std::make_shared<const TriangleMesh>(make_mesh::torus(0.3, 0.02, 20, 8));
  for (int k = 0; k < 6; ++k) {
    BodyDef& ring = out.emplace_back();
    ring.shapes.emplace_back();
    ring.shapes[0].shape.type = ShapeType::triangle_mesh;
    ring.shapes[0].shape.mesh = wire;
    ring.pose.x = {0.1 * (k % 2), 0.5 + 0.15 * k, 0.07 * (k % 3)};
    ring.angular_velocity = {30.0 - 11 * k, 2, 25};
  }
  return out;
}

/// The first bodies watched, the others beside them.
Watched together(const std::vector<BodyDef>& own, const std::vector<BodyDef>& others, Order order,
                 const WorldSettings& settings = {}) {
  Workload w;
  w.bodies = own;
  w.bodies.insert(order == Order::before ? w.bodies.begin() : w.bodies.end(), others.begin(),
                  others.end());
  WorldDef def;
  def.settings = settings;
  auto made = build_workload(w, def);
  REQUIRE_MESSAGE(made.ok(), test::why_not(made));
  const size_t first = order == Order::before ? others.size() : 0;
  const auto begin = made->bodies.begin() + std::ptrdiff_t(first);
  return {std::move(made->world), {begin, begin + std::ptrdiff_t(own.size())}};
}

/// Bits of all that is watched, after every tick.
std::vector<uint64_t> history(Watched w, int ticks) {
  std::vector<uint64_t> out;
  for (int i = 0; i < ticks; ++i) {
    REQUIRE(w.world->step().ok());
    for (const BodyId id : w.bodies) {
      const RigidBody& b = *w.world->body(id);
      for (const Vec3& v : {b.pose.x, b.v, b.omega})
        for (int k = 0; k < 3; ++k) out.push_back(std::bit_cast<uint64_t>(v[k]));
      for (int k = 0; k < 4; ++k) out.push_back(std::bit_cast<uint64_t>(b.pose.q.coeffs()[k]));
      out.push_back(uint64_t{b.asleep});
    }
  }
  return out;
}

using Recipe = std::function<Watched(CrowdKind, Order)>;

void check_alone_in_the_world(const Recipe& make, int all_ticks) {
  const int ticks = test::graded_count(all_ticks, all_ticks / 4, 3);
  const std::vector<uint64_t> alone = history(make(CrowdKind::none, Order::after), ticks);
  const auto check = [&](CrowdKind crowd, Order order) {
    CAPTURE(int(crowd));
    CAPTURE(int(order));
    const std::vector<uint64_t> beside = history(make(crowd, order), ticks);
    REQUIRE(alone.size() == beside.size());
    const auto [a, b] = std::ranges::mismatch(alone, beside);
    const auto same = a - alone.begin();
    CAPTURE(same / std::ptrdiff_t(alone.size() / size_t(ticks)));  // the tick
    CHECK(a == alone.end());
  };
  if (test::only_to_run()) return check(CrowdKind::bouncing, Order::after);
  for (const CrowdKind crowd : {CrowdKind::awake, CrowdKind::asleep, CrowdKind::bouncing})
    check(crowd, Order::after);
  check(CrowdKind::awake, Order::before);
}

Recipe shipped_scene(const std::string& name, std::vector<std::string> overrides = {}) {
  return [=](CrowdKind crowd, Order order) { return scene(name, crowd, order, overrides); };
}

Recipe small_workload(std::string_view name) {
  return [=](CrowdKind crowd, Order order) { return workload(name, crowd, order); };
}

}  // namespace

TEST_CASE("a card house stands the same whatever else is in the world" *
          doctest::test_suite("long")) {
  check_alone_in_the_world(shipped_scene("card_house"), 120);
}

TEST_CASE("light boxes bear heavy ones the same whatever else is in the world" *
          doctest::test_suite("long")) {
  check_alone_in_the_world(shipped_scene("mass_ratio", {"settings.stepper=realtime"}), 90);
}

TEST_CASE("chains, hinges and pendulums move the same whatever else is in the world" *
          doctest::test_suite("long")) {
  check_alone_in_the_world(shipped_scene("joints"), 90);
  check_alone_in_the_world(shipped_scene("pendulums"), 90);
  check_alone_in_the_world(small_workload("W5"), 60);
}

TEST_CASE("ragdolls fall the same whatever else is in the world") {
  check_alone_in_the_world(small_workload("W6"), 120);
}

TEST_CASE("towers, hulls and balls move the same whatever else is in the world" *
          doctest::test_suite("long")) {
  check_alone_in_the_world(shipped_scene("tower"), 60);
  for (const char* name : {"W2", "W3", "W4", "W8"}) {
    CAPTURE(name);
    check_alone_in_the_world(small_workload(name), 90);
  }
}

TEST_CASE("thin rings that spin fast move the same whatever else is in the world") {
  check_alone_in_the_world(
      [](CrowdKind crowd, Order order) {
        return together(fast_rings(), crowd_bodies(crowd), order);
      },
      60);
  if (test::only_to_run()) return;
  // Their tick has parts inundo_step: with one they come elsewhere.
  WorldSettings whole;
  whole.realtime.max_parts = 1;
  CHECK(history(together(fast_rings(), {}, Order::after), 60) !=
        history(together(fast_rings(), {}, Order::after, whole), 60));
}

TEST_CASE("a crowd moves the same whether or not thin rings spin fast elsewhere" *
          doctest::test_suite("long")) {
  check_alone_in_the_world(
      [](CrowdKind rings, Order order) {
        return together(crowd_bodies(CrowdKind::bouncing),
                        rings == CrowdKind::none ? std::vector<BodyDef>{} : fast_rings(), order);
      },
      40);
}

TEST_CASE("with thin rings beside a crowd the books and counts are those of both") {
  const auto crowd = crowd_bodies(CrowdKind::bouncing);
  const Watched rings = together(fast_rings(), {}, Order::after);
  const Watched others = together(crowd, {}, Order::after);
  const Watched both = together(fast_rings(), crowd, Order::after);
  for (int tick = 0; tick < test::graded_count(40, 40, 5); ++tick) {
    CAPTURE(tick);
    for (const Watched* w : {&rings, &others, &both}) REQUIRE(w->world->step().ok());
    const auto a = rings.world->frame(), b = others.world->frame(), sum = both.world->frame();
    CHECK(sum->stats.awake == a->stats.awake + b->stats.awake);
    CHECK(sum->stats.islands == a->stats.islands + b->stats.islands);
    CHECK(sum->stats.contacts == a->stats.contacts + b->stats.contacts);
    CHECK(sum->stats.contact_points == a->stats.contact_points + b->stats.contact_points);
    CHECK(sum->stats.max_penetration ==
          std::max(a->stats.max_penetration, b->stats.max_penetration));
    const double rounding = 1e-12 * sum->ledger->throughput();
    for (size_t k = 0; k < ledger_lines; ++k) {
      const auto line = LedgerLine(k);
      CAPTURE(ledger_line_name(line));
      const LedgerEntry of_a = a->ledger->line(line).tick, of_b = b->ledger->line(line).tick;
      const LedgerEntry of_both = sum->ledger->line(line).tick;
      CHECK(std::abs(of_both.work - of_a.work - of_b.work) <= rounding);
      CHECK(std::abs(of_both.balance - of_a.balance - of_b.balance) <= rounding);
      CHECK((of_both.momentum - of_a.momentum - of_b.momentum).norm() <= rounding);
    }
  }
}
