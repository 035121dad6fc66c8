// Microscopes that ask the world, and the descent of hierarchies. References: weights, closed forms
// of falls and slides, brute force over triangles, the plain queries' own counts, the solver's
// report, the state hash of a world that nobody looked at.
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "engine/geometry/hierarchy/watched_descent.hpp"
#include "engine/world/microscope/microscope.hpp"
#include "engine/world/tick_watch.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

WorldSettings stepped_by(const char* stepper) {
  WorldSettings s;
  s.stepper = stepper;
  return s;
}

MicroscopeSetup of_body(const char* algorithm, BodyId a) {
  MicroscopeSetup setup;
  setup.algorithm = algorithm;
  setup.a = a;
  return setup;
}

/// What every step of every recording must be.
void check_words(const MicroscopeRecording& recording) {
  CHECK_FALSE(recording.title.empty());
  REQUIRE_FALSE(recording.steps.empty());
  for (const MicroscopeStep& step : recording.steps) {
    CAPTURE(step.title);
    CAPTURE(step.caption);
    CHECK((step.title.size() > 3 && step.title.size() < 64));
    CHECK((step.caption.size() > 40 && step.caption.size() < 360));
    CHECK_FALSE(step.numbers.empty());
    CHECK_FALSE(step.diagram.empty());
    for (const auto& l : step.diagram.lines)
      for (const Vec2& p : {l.a, l.b})
        CHECK((p.x() >= 0 && p.x() <= step.diagram.aspect && p.y() >= 0 && p.y() <= 1));
    for (const auto& b : step.diagram.boxes) {
      CHECK((b.min.x() >= 0 && b.max.x() <= step.diagram.aspect));
      CHECK((b.min.y() >= 0 && b.max.y() <= 1));
    }
    for (const auto& l : step.sketch.lines) CHECK((l.a.allFinite() && l.b.allFinite()));
    for (const std::string* text : {&step.title, &step.caption})
      for (const char c : *text) CHECK(uint8_t(c) < 128);
  }
}

MicroscopeRecording asked(const World& world, const MicroscopeSetup& setup) {
  const uint64_t before = world.state_hash();
  const auto answer = ask_world(world, setup);
  REQUIRE(answer);
  REQUIRE_MESSAGE(answer->recording.has_value(), answer->refusal);
  CHECK(answer->tick == world.tick());
  CHECK(world.state_hash() == before);
  check_words(*answer->recording);
  return *answer->recording;
}

}  // namespace

TEST_CASE("pivots of a stack end at the weights that its contacts bear") {
  for (const char* stepper : {"event", "realtime"}) {
    CAPTURE(stepper);
    TestWorld w(stepped_by(stepper));
    w.ground();
    std::array<BodyId, 3> box;
    for (int i = 0; i < 3; ++i) box[size_t(i)] = w.box({0, 0.5 + i, 0});
    w.run(0.5);
    double weight = 0;
    for (int i = 0; i < 3; ++i) weight += (3 - i) * 9.81 / w.body(box[size_t(i)]).inverse_mass;
    for (const char* algorithm : {"dantzig", "baraff"}) {
      CAPTURE(algorithm);
      const MicroscopeRecording r = asked(*w.world, of_body(algorithm, box[1]));
      CHECK(r.answer == doctest::Approx(weight).epsilon(1e-6));
      CHECK(r.steps.front().title == "All contact forces are 0");
      CHECK(r.steps.back().title == "All conditions hold");
      CHECK(r.steps.size() > 4);
      CHECK(r.see_through.size() == 3);
      // Three faces of four corners each.
      CHECK(r.steps.front().sketch.labels.size() == 12);
    }
  }
}

TEST_CASE("Baraff's pivots of a box on a slope hold it by friction, Dantzig's have none") {
  TestWorld w(stepped_by("event"));
  ShapeDef plane;
  plane.type = ShapeType::half_space;
  const double angle = 0.3;
  const Quat tilt = Quat(std::cos(0.5 * angle), 0, 0, std::sin(0.5 * angle));
  BodyDef slope = TestWorld::shape_def(plane, Vec3::Zero(), BodyType::fixed);
  slope.pose.q = tilt;
  w.add(slope);
  BodyDef def = TestWorld::box_def(tilt * Vec3(0, 0.5, 0));
  def.pose.q = tilt;
  const BodyId box = w.add(def);
  w.run(0.1);
  const double weight = 9.81 / w.body(box).inverse_mass;
  const MicroscopeRecording cones = asked(*w.world, of_body("baraff", box));
  CHECK(cones.answer == doctest::Approx(weight * std::cos(angle)).epsilon(1e-6));
  const MicroscopeRecording smooth = asked(*w.world, of_body("dantzig", box));
  CHECK(smooth.answer == doctest::Approx(weight * std::cos(angle)).epsilon(1e-6));
}

TEST_CASE("the search for the first event ends when a ball that falls hits the floor") {
  for (const char* stepper : {"event", "realtime"}) {
    CAPTURE(stepper);
    TestWorld w(stepped_by(stepper));
    w.ground();
    const BodyId ball = w.sphere({0, 1.5, 0});
    const MicroscopeRecording r = asked(*w.world, of_body("first_event", ball));
    CHECK(r.answer == doctest::Approx(std::sqrt(2 * 1.0 / 9.81)).epsilon(1e-9));
    CHECK(r.steps.back().title == "First event: a gap closes");
    MicroscopeSetup near = of_body("first_event", ball);
    near.span = 0.2;
    const auto answer = ask_world(*w.world, near);
    CHECK((!answer->recording || std::isinf(answer->recording->answer)));
  }
}

TEST_CASE("the search for the first event ends when a slide ends") {
  TestWorld w(stepped_by("event"));
  w.ground();
  BodyDef def = TestWorld::box_def({0, 0.25, 0}, {0.5, 0.25, 0.5});
  def.velocity = {0.6, 0, 0};
  const BodyId box = w.add(def);
  w.step();
  const double speed = w.body(box).v.x();
  const MicroscopeRecording r = asked(*w.world, of_body("first_event", box));
  CHECK(r.answer == doctest::Approx(speed / (0.5 * 9.81)).epsilon(1e-6));
  CHECK(r.steps.back().title == "First event: a slip ends");
}

TEST_CASE("a tick that is watched is the tick that it would have been") {
  TestWorld w(stepped_by("event")), plain(stepped_by("event"));
  TickWatch watch;
  for (TestWorld* each : {&w, &plain}) {
    each->ground();
    watch.body = each->sphere({0, 0.6, 0});
    each->box({0.2, 2, 0});
  }
  w->watch_with(&watch);
  size_t searches = 0;
  for (int i = 0; i < 40; ++i) {
    watch.searches.searches.clear();
    w.step(), plain.step();
    CHECK(w->state_hash() == plain->state_hash());
    searches += watch.searches.searches.size();
    for (const EventSearch& s : watch.searches.searches) {
      CHECK(s.found <= s.step);
      for (const SearchLook& l : s.looks) CHECK(l.value < s.watched.size());
    }
  }
  CHECK(searches >= 40);
}

TEST_CASE("the steps of a descent have the plain query's counts and find what brute force finds") {
  auto knot = std::make_shared<TriangleMesh>();
  constexpr uint32_t around = 24, across = 10;
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < across; ++j) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / across;
      knot->vertices.emplace_back((1 + 0.3 * std::cos(v)) * std::cos(u), 0.3 * std::sin(v),
                                  -(1 + 0.3 * std::cos(v)) * std::sin(u));
    }
  const auto at = [&](uint32_t i, uint32_t j) { return i % around * across + j % across; };
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < across; ++j) {
      knot->triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      knot->triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  ShapeDef def;
  def.type = ShapeType::triangle_mesh;
  def.mesh = knot;
  auto ring = make_shape(def);
  REQUIRE_MESSAGE(ring.ok(), test::why_not(ring));
  MicroscopeSlide slide;
  const Pose a{Vec3::Zero(), Quat::Identity()},
      b{Vec3(0.6, 0.2, 0.1), Quat(0.7, 0.6, 0.1, 0.3).normalized()};
  slide.body[0] = {"first", *ring, Motion::at_rest(a, 0, 1)};
  slide.body[1] = {"second", *ring, Motion::at_rest(b, 0, 1)};
  slide.tolerance = 0.01;
  const auto mesh = (*ring)->polyhedral()->surface().mesh;
  for (const auto& [algorithm, kind] :
       {std::pair{"descent", "aabb"}, {"descent_obb", "obb"}, {"descent_sphere", "sphere"}}) {
    const auto& shown_algorithm = algorithm;
    CAPTURE(shown_algorithm);
    const MicroscopeEntry& entry = *find_microscope(algorithm);
    CHECK(entry.of_pair()->refusal(**ring, **ring) == "");
    const MicroscopeRecording r = entry.record(slide);
    check_words(r);
    std::vector<TriangleIds> found, brute;
    HierarchyStatistics cost;
    for (const HierarchyKind& k : all_hierarchies()) {
      if (k.name != kind && k.name != "brute_force") continue;
      const auto one = k.build(mesh), other = k.build(mesh);
      if (k.name == kind)
        one->pairs(*other, a.inverse() * b, slide.tolerance, found, &cost);
      else
        one->pairs(*other, a.inverse() * b, slide.tolerance, brute);
    }
    CHECK(found == brute);
    CHECK(brute.size() > 4);
    CHECK(r.answer == double(brute.size()));
    const auto number = [&](std::string_view label) {
      for (const auto& n : r.steps.back().numbers)
        if (n.label == label) return n.value;
      return std::string();
    };
    CHECK(number("pairs of nodes tested") == std::to_string(cost.node_tests));
    CHECK(number("pairs of triangles tested") == std::to_string(cost.triangle_tests));
    CHECK(cost.node_tests + cost.triangle_tests < mesh->triangles.size() * mesh->triangles.size());
    // With the tree of the slide before it says the same; both bodies share one.
    MicroscopeSlide kept = slide;
    kept.memory = std::make_shared<MicroscopeMemory>();
    const MicroscopeRecording first = entry.record(kept);
    REQUIRE(kept.memory->trees.size() == 1);
    const auto tree = kept.memory->trees[0].tree;
    const MicroscopeRecording again = entry.record(kept);
    CHECK(kept.memory->trees[0].tree == tree);
    CHECK(first.answer == r.answer);
    CHECK(again.answer == r.answer);
    CHECK(again.steps.size() == r.steps.size());
  }
  // One that is broken off holds the first tests of the whole way.
  const BoundingTree<AabbKind> tree(mesh);
  const Pose b_in_a = a.inverse() * b;
  const WatchedDescent whole = watch_pairs(tree, tree, b_in_a, slide.tolerance, 1'000'000);
  CHECK(whole.whole);
  REQUIRE(whole.tests.size() > 50);
  const WatchedDescent part = watch_pairs(tree, tree, b_in_a, slide.tolerance, 50);
  CHECK_FALSE(part.whole);
  REQUIRE(part.tests.size() > 10);
  REQUIRE(part.tests.size() <= 50);
  for (size_t i = 0; i < part.tests.size(); ++i) {
    CHECK(part.tests[i].a == whole.tests[i].a);
    CHECK(part.tests[i].b == whole.tests[i].b);
  }
  CHECK(std::ranges::includes(whole.found, part.found));
}

TEST_CASE("iterations of dfsph end at the error that the solver tells, particle by particle") {
  constexpr double spacing = 0.1;
  TestWorld w, plain;
  ParticleSystemId water;
  for (TestWorld* each : {&w, &plain}) {
    each->ground();
    ParticleSystemDef def;
    def.name = "water";
    def.collide = false;
    def.fluid = std::make_shared<const FluidDef>();
    for (int i = 0; i < 125; ++i) {
      ParticleDef p;
      p.x = spacing * Vec3(i % 5 + 0.5, i / 5 % 5 + 0.5, i / 25 + 0.5);
      p.mass = def.fluid->density * spacing * spacing * spacing;
      p.radius = 0.5 * spacing;
      def.particles.push_back(p);
    }
    const auto id = (*each)->create_particles(std::move(def));
    REQUIRE(id.ok());
    water = *id;
    each->apply();
    each->run(0.1);
  }
  MicroscopeSetup setup;
  setup.algorithm = "dfsph";
  const MicroscopeRecording r = asked(*w.world, setup);
  for (const MicroscopeStep& step : r.steps) {
    REQUIRE(step.particles.has_value());
    CHECK(step.particles->system == water);
    REQUIRE(step.particles->value.size() == 125);
  }
  const std::vector<float>& last = r.steps.back().particles->value;
  const double mean = std::accumulate(last.begin(), last.end(), 0.0) / double(last.size());
  CHECK(mean == doctest::Approx(100 * r.answer).epsilon(1e-5));
  TickWatch watch;
  watch.fluid = water;
  w->watch_with(&watch);
  w.step(), plain.step();
  w->watch_with(nullptr);
  CHECK(w->state_hash() == plain->state_hash());
  const FluidTrace& trace = watch.pressures;
  CHECK(r.steps.size() == trace.pressure.iterations.size() + trace.shift.iterations.size());
  CHECK(r.answer == trace.shift.iterations.back().error);
  CHECK(trace.shift.iterations.back().error <= trace.shift.enough);
  CHECK(trace.pressure.iterations.back().error <= trace.pressure.enough);
}

TEST_CASE("of a solve of dfsph that takes hundreds of iterations the first and the last are kept") {
  constexpr double spacing = 0.1;
  TestWorld w;
  w.ground();
  ParticleSystemDef def;
  def.collide = false;
  auto fluid = std::make_shared<FluidDef>();
  fluid->density_error = 1e-30;  // which rounding does not let it reach
  fluid->most_iterations = 250;
  def.fluid = fluid;
  for (int i = 0; i < 27; ++i) {
    ParticleDef p;
    p.x = 0.8 * spacing * Vec3(i % 3 + 0.5, i / 3 % 3 + 0.5, i / 9 + 0.5);  // too dense
    p.mass = fluid->density * spacing * spacing * spacing;
    p.radius = 0.5 * spacing;
    def.particles.push_back(p);
  }
  const auto id = w->create_particles(std::move(def));
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  w.apply();
  TickWatch watch;
  watch.fluid = *id;
  w->watch_with(&watch);
  w.step();
  w->watch_with(nullptr);
  for (const auto* solve : {&watch.pressures.pressure, &watch.pressures.shift}) {
    const auto& all = solve->iterations;
    REQUIRE_FALSE(all.empty());
    CHECK(all.size() <= FluidTrace::most_kept);
    for (size_t i = 0; i + 1 < all.size(); ++i) CHECK(all[i].number == int(i));
    for (const auto& one : all) CHECK(one.wrong.size() == 27);
  }
  const auto& longest = watch.pressures.shift.iterations;
  CHECK(longest.size() == FluidTrace::most_kept);
  CHECK(longest.back().number == 250);
}

TEST_CASE("what cannot be asked is refused with a reason") {
  TestWorld w(stepped_by("event"));
  const BodyId floor = w.ground(), ball = w.sphere({0, 5, 0});
  const auto why = [&](const MicroscopeSetup& setup) {
    return microscope_refusal(*w->frame(), setup);
  };
  CHECK(why(of_body("dantzig", BodyId{})).find("no body is chosen") != std::string::npos);
  CHECK(why(of_body("dantzig", ball)).find("touches nothing") != std::string::npos);
  CHECK(why(of_body("first_event", floor)).find("do not move") != std::string::npos);
  CHECK(why(of_body("baraff", BodyId{77, 3})).find("gone") != std::string::npos);
  MicroscopeSetup fluid;
  fluid.algorithm = "dfsph";
  CHECK(why(fluid).find("no particles") != std::string::npos);
  CHECK(why(of_body("gjk", ball)).find("body B is missing") != std::string::npos);
  CHECK(ask_world(*w.world, of_body("gjk", ball)) == nullptr);
  const auto far = ask_world(*w.world, of_body("dantzig", ball));
  CHECK(!far->recording);
  CHECK(far->refusal.find("touches nothing") != std::string::npos);
}
