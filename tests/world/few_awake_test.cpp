// Worlds of which most sleeps, stepped by what is kept of the sleepers while bodies are hit, moved,
// made and removed. Reference: the same world, in every tick of which settings are set that change
// nothing, so that it looks at everything; or which is loaded from its own snapshot again and
// again. Equal to the bit.
#include "engine/core/random.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <tuple>

#include <doctest/doctest.h>

using namespace tumble;
using test::scaled;
using test::TestWorld;

namespace {

constexpr int side = 14;

/// Boxes asleep on the ground, singly and in stacks, some tied to each other; a platform with
/// boxes on it; and what the same seed does to them.
struct Yard {
  TestWorld w;
  Random r;
  std::vector<BodyId> boxes;
  BodyId platform, block;
  ForceId breeze;
  JointId link;
  bool windy = false, linked = false;

  Yard(uint64_t seed, const char* broad_phase, bool grains) : w(settings(broad_phase)), r(seed) {
    w.ground();
    for (int i = 0; i < side * side; ++i) {
      const Vec3 at(2.0 * (i % side), 0, 2.0 * (i / side));
      for (int level = 0; level < (i % 9 == 0 ? 3 : 1); ++level) sleeper(at, 0.5 + level);
    }
    BodyDef def = TestWorld::box_def({-6, 1, 5}, {2, 0.1, 4});
    def.type = BodyType::kinematic;
    platform = make(def);
    for (int k = 0; k < 4; ++k) sleeper({-6, 0, 2.0 + 2 * k}, 1.6);
    def = TestWorld::box_def({-1.02, 0.5, 0});
    def.type = BodyType::fixed;
    block = make(def);
    w.apply();
    tie();
    if (grains) pour();
  }
  static WorldSettings settings(const char* broad_phase) {
    WorldSettings s;
    s.broad_phase = broad_phase;
    return s;
  }
  BodyId make(const BodyDef& def) {
    const auto id = w->create_body(def);
    REQUIRE(id.ok());
    return *id;
  }
  void sleeper(const Vec3& at, double height) {
    BodyDef def = TestWorld::box_def({at.x(), height, at.z()});
    def.starts_asleep = true;
    boxes.push_back(make(def));
  }
  void tie() {
    for (size_t k = 20; k + 1 < 40; k += 4) {
      SpringDef spring;
      spring.a.kind = spring.b.kind = Anchor::Kind::body;
      spring.a.body = boxes[k];
      spring.b.body = boxes[k + 1];
      spring.stiffness = 50;
      spring.rest_length = 2;
      REQUIRE(w->create_force(spring).ok());
    }
  }
  void pour() {
    ParticleSystemDef def;
    for (int k = 0; k < 12; ++k) {
      def.particles.push_back({});
      def.particles.back().x = {2.0 + 0.1 * k, 2.0 + 0.3 * k, 2.0};
      def.particles.back().mass = 0.5;
      def.particles.back().radius = 0.05;
    }
    REQUIRE(w->create_particles(def).ok());
  }
  Vec3 above(double y) { return {r.uniform(0, 2 * side), y, r.uniform(0, 2 * side)}; }
  /// A box that there still is.
  BodyId any_box() {
    std::erase_if(boxes, [this](BodyId id) { return !w->body(id); });
    return boxes[r.below(uint32_t(boxes.size()))];
  }
  void drop_ball() {
    BodyDef def = TestWorld::sphere_def(above(2.5), 0.3);
    def.velocity = {0, -4, 0};
    boxes.push_back(make(def));
  }
  void shoot() {
    BodyDef def = TestWorld::sphere_def({-20, 0.5, 2.0 * r.below(side)}, 0.1);
    def.velocity = {90, 0, 0};
    def.mass = 100;
    boxes.push_back(make(def));
  }
  void start_or_stop(const Vec3& v) {
    const bool stands = w.body(platform).v.isZero(0);
    REQUIRE(w->set_velocity(platform, stands ? v : Vec3::Zero(), Vec3::Zero()).ok());
  }
  void blow_or_calm() {
    if (windy) {
      REQUIRE(w->destroy_force(breeze).ok());
    } else {
      WindDef wind;
      wind.targets.bodies = {any_box()};
      wind.gusts = r.below(2) ? 0.5 : 0;
      const auto id = w->create_force(wind);
      REQUIRE_MESSAGE(id.ok(), test::why_not(id));
      breeze = *id;
    }
    windy = !windy;
  }
  void link_or_part() {
    if (linked && w->joint(link)) {
      REQUIRE(w->destroy_joint(link).ok());
      linked = false;
      return;
    }
    JointDef def;
    def.a = any_box();
    def.b = any_box();
    if (def.a == def.b) return;
    def.frame_b.x = w.body(def.b).body_frame().inverse_point(w.body(def.a).pose.x);
    const auto id = w->create_joint(def);
    REQUIRE_MESSAGE(id.ok(), test::why_not(id));
    link = *id;
    linked = true;
  }
  void disturb() {
    switch (r.below(12)) {
      case 0:
      case 1:
        return drop_ball();
      case 2:
        return shoot();
      case 3:
        if (boxes.size() > 100) REQUIRE(w->destroy_body(any_box()).ok());
        return;
      case 4: {
        const BodyId box = any_box();
        const Pose pose = w.body(box).body_frame();
        REQUIRE(w->set_pose(box, {pose.x + Vec3(0, 0.4, 0), pose.q}).ok());
        return;
      }
      case 5:
        REQUIRE(w->apply_impulse(any_box(), {900, 0, 300}, above(0.5)).ok());
        return;
      case 6:
        return start_or_stop({0.4, 0, 0});
      case 7:
        return start_or_stop({0, -0.2, 0});
      case 8: {
        const Vec3 at(2.0 * r.below(side) - 1, 0.5, -1);
        REQUIRE(w->set_pose(block, {at, Quat::Identity()}).ok());
        return;
      }
      case 9:
        return sleeper({-30 - 2.0 * double(boxes.size()), 0, 0}, 0.5);
      case 10:
        return blow_or_calm();
      default:
        return link_or_part();
    }
  }
};

auto by_value(const ContactFrame& c) {
  return std::tuple(c.a.index, c.b.index, c.x_world.x(), c.x_world.y(), c.x_world.z(), c.normal.x(),
                    c.normal.y(), c.normal.z(), c.gap, c.impulse.x(), c.impulse.y(), c.impulse.z());
}

std::vector<ContactFrame> sorted(const Frame& frame) {
  std::vector<ContactFrame> contacts = frame.all_contacts();
  std::ranges::sort(contacts, {}, by_value);
  return contacts;
}

void check_equal(const Frame& one, const Frame& other) {
  CHECK(one.stats.awake == other.stats.awake);
  CHECK(one.stats.islands == other.stats.islands);
  CHECK(one.stats.contacts == other.stats.contacts);
  CHECK(one.stats.contact_points == other.stats.contact_points);
  CHECK(one.stats.max_penetration == other.stats.max_penetration);
  CHECK(one.stats.energies.kinetic == other.stats.energies.kinetic);
  CHECK(one.stats.energies.gravity == other.stats.energies.gravity);
  CHECK(one.stats.energies.springs == other.stats.energies.springs);
  REQUIRE(one.body_slots() == other.body_slots());
  for (size_t slot = 0; slot < one.body_slots(); ++slot) {
    const BodyFrame &a = one.body(slot), &b = other.body(slot);
    const bool same_rest = a.id == b.id && a.island == b.island && a.asleep == b.asleep;
    CHECK(same_rest);
  }
  // Which of them are put away differs where a snapshot was loaded.
  const bool same_contacts = std::ranges::equal(sorted(one), sorted(other), {}, by_value, by_value);
  CHECK(same_contacts);
  // Of two convex shapes there are four points at most, unless a contact is there twice.
  std::map<std::pair<uint32_t, uint32_t>, int> points;
  one.for_contacts([&points](const ContactFrame& c) { ++points[{c.a.index, c.b.index}]; });
  CHECK(std::ranges::all_of(points, [](const auto& p) { return p.second <= 4; }));
}

/// Steps two yards of one seed, one of which `treat` sees before every tick.
struct Twins {
  Yard plain, other;
  int few = 0, ticks = 0;  ///< of them, with less than a quarter awake

  Twins(uint64_t seed, const char* broad_phase, bool grains = false)
      : plain(seed, broad_phase, grains), other(seed, broad_phase, grains) {}
  void run(int count, const std::function<void(Yard&, int)>& treat) {
    for (int tick = 0; tick < count; ++tick) {
      if (tick % 7 == 5)
        for (Yard* yard : {&plain, &other}) yard->disturb();
      treat(other, tick);
      plain.w.step();
      other.w.step();
      const auto frame = plain.w->frame();
      REQUIRE(plain.w->state_hash() == other.w->state_hash());
      check_equal(*frame, *other.w->frame());
      few += 4 * frame->stats.awake < frame->stats.bodies;
      ++ticks;
    }
  }
};

void set_same(Yard& yard, int) {
  REQUIRE(yard.w->set_settings(yard.w->settings()).ok());
}

}  // namespace

TEST_CASE("a world of few awake does what it does when everything is looked at in every tick") {
  const int worlds = scaled(6);
  for (int k = 0; k < worlds; ++k) {
    Twins twins(uint64_t(k + 1), k % 2 ? "aabb_tree" : "uniform_grid");
    twins.run(60 + scaled(240), set_same);
    CHECK(twins.few > twins.ticks / 2);
  }
}

TEST_CASE("particles that fall on sleepers do to them what they do when all is looked at") {
  Twins twins(11, "multi_level_grid", true);
  twins.run(40 + scaled(160), set_same);
}

TEST_CASE("a world of few awake goes on from a snapshot as if it had not been saved") {
  Twins twins(21, "uniform_grid");
  twins.run(60 + scaled(240), [](Yard& yard, int tick) {
    if (tick % 5 != 3) return;
    yard.w.apply();
    REQUIRE(yard.w->load(yard.w->save()).ok());
  });
}

TEST_CASE("ticks that fail among sleepers leave no trace") {
  // A body runs out of the numbers there are. Reference: the same world, where it stands still.
  Twins twins(31, "uniform_grid");
  int failed = 0;
  for (int round = 0; round < 3; ++round) {
    BodyDef def = TestWorld::sphere_def({1.7976e308, 1e3, 0});
    def.type = BodyType::kinematic;
    const BodyId stands = twins.other.make(def);
    def.velocity = {1.2e305, 0, 0};
    const BodyId runs = twins.plain.make(def);
    for (Yard* yard : {&twins.plain, &twins.other}) yard->drop_ball();
    for (int tick = 0; tick < 30; ++tick) {
      if (!twins.plain.w->step().ok()) {
        ++failed;
        CHECK_FALSE(twins.plain.w->step().ok());
        break;
      }
      twins.other.w.step();
      check_equal(*twins.plain.w->frame(), *twins.other.w->frame());
    }
    REQUIRE(twins.plain.w->destroy_body(runs).ok());
    REQUIRE(twins.other.w->destroy_body(stands).ok());
    twins.run(20 + scaled(40), [](Yard&, int) {});
  }
  CHECK(failed == 3);
}
