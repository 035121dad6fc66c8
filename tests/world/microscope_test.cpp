// The recorders end where the plain calls end. References: gjk() and epa(), v_clip() with its
// trace, time_of_contact(), closed forms of boxes and balls, the table of transitions of
// v_clip.hpp.
#include "engine/world/microscope/microscope.hpp"

#include "engine/collision/gjk/epa.hpp"
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/time_of_contact.hpp"
#include "engine/collision/v_clip/v_clip.hpp"
#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "engine/world/microscope/v_clip_words.hpp"
#include "tests/support/test_world.hpp"

#include <cmath>
#include <set>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

std::shared_ptr<const Shape> made(const ShapeDef& def) {
  auto shape = make_shape(def);
  REQUIRE(shape.ok());
  return *shape;
}
std::shared_ptr<const Shape> block(const Vec3& half) {
  ShapeDef def;
  def.type = ShapeType::box;
  def.half_extents = half;
  return made(def);
}
std::shared_ptr<const Shape> round_shape(ShapeType type, double radius) {
  ShapeDef def;
  def.type = type;
  def.radius = radius;
  return made(def);
}
double draw(Random& r) {
  return r.uniform(-1, 1);
}
Vec3 draw_vec(Random& r) {
  const double x = draw(r), y = draw(r);
  return {x, y, draw(r)};
}
Quat draw_turn(Random& r) {
  const Vec3 v = draw_vec(r);
  return Quat(draw(r) + 1.5, v.x(), v.y(), v.z()).normalized();
}
std::shared_ptr<const Shape> stone(Random& r) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int i = 0; i < 14; ++i) mesh->vertices.push_back(draw_vec(r));
  ShapeDef def;
  def.type = ShapeType::convex_hull;
  def.mesh = mesh;
  return made(def);
}

MicroscopeSlide slide_of(const std::shared_ptr<const Shape>& a, const Pose& pa,
                         const std::shared_ptr<const Shape>& b, const Pose& pb) {
  MicroscopeSlide slide;
  slide.body[0] = {"first", a, Motion::at_rest(pa, 0, 1)};
  slide.body[1] = {"second", b, Motion::at_rest(pb, 0, 1)};
  slide.beside = Vec3(5, 0, 0);
  return slide;
}

/// What every step of every recording must be.
void check_steps(const MicroscopeRecording& recording) {
  CHECK_FALSE(recording.title.empty());
  REQUIRE_FALSE(recording.steps.empty());
  for (const MicroscopeStep& step : recording.steps) {
    CAPTURE(step.title);
    CHECK(step.title.size() > 3);
    CHECK(step.title.size() < 64);  // one line of a picture
    CHECK(step.caption.size() > 40);
    CHECK(step.caption.size() < 360);
    CHECK_FALSE(step.numbers.empty());
    CHECK_FALSE(step.sketch.ghosts.empty());
    for (const auto& p : step.sketch.points) CHECK(p.x.allFinite());
    for (const auto& l : step.sketch.lines) CHECK((l.a.allFinite() && l.b.allFinite()));
    for (const auto& l : step.diagram.lines)
      for (const Vec2& p : {l.a, l.b}) {
        CHECK((p.x() >= 0 && p.x() <= step.diagram.aspect));
        CHECK((p.y() >= 0 && p.y() <= 1));
      }
    for (const std::string* text : {&step.title, &step.caption})
      for (const char c : *text) CHECK(uint8_t(c) < 128);  // the built-in font has these
  }
}

}  // namespace

TEST_CASE("the steps of GJK end at the distance, or at EPA's depth") {
  Random r(71);
  int apart = 0, overlapping = 0;
  for (int i = 0; i < scaled(60); ++i) {
    const auto a = stone(r), b = i % 3 ? stone(r) : block({0.5, 0.3, 0.8});
    const Pose pa{draw_vec(r), draw_turn(r)}, pb{pa.x + 1.8 * draw_vec(r), draw_turn(r)};
    const MicroscopeRecording recording = find_microscope("gjk")->record(slide_of(a, pa, b, pb));
    check_steps(recording);
    const PlacedCore A(*a->convex(), pa.q, Vec3::Zero()), B(*b->convex(), pb.q, pb.x - pa.x);
    const GjkResult g = gjk(A, B);
    if (g.status == GjkStatus::separated) {
      ++apart;
      CHECK(recording.answer == doctest::Approx(g.distance).epsilon(1e-10));
      CHECK(recording.steps.back().title == "The bounds have met");
      CHECK(int(recording.steps.size()) <= 2 * g.iterations + 4);
    } else {
      ++overlapping;
      CHECK(recording.answer == doctest::Approx(-epa(A, B, g.simplex).depth).epsilon(1e-8));
      CHECK(recording.steps.back().title == "The depth is known");
    }
  }
  if (scaled(60) >= 60) CHECK((apart > 10 && overlapping > 10));
}

TEST_CASE("GJK's steps of balls, capsules and cylinders allow for their rounding") {
  const auto ball = round_shape(ShapeType::sphere, 0.5),
             can = round_shape(ShapeType::cylinder, 0.4);
  const auto pill = round_shape(ShapeType::capsule, 0.25);
  const auto far = [](const auto& a, const auto& b, double distance) {
    return slide_of(a, Pose{}, b, Pose{Vec3(distance, 0, 0), Quat::Identity()});
  };
  const auto& look = *find_microscope("gjk");
  for (const double gap : {0.7, -0.2}) {
    const auto balls = look.record(far(ball, ball, 1 + gap));
    check_steps(balls);
    CHECK(balls.answer == doctest::Approx(gap));
    const auto pills = look.record(far(pill, can, 0.65 + gap));
    check_steps(pills);
    CHECK(pills.answer == doctest::Approx(gap).epsilon(1e-6));
  }
}

TEST_CASE("the steps of V-Clip are its walk, and each move is one of the published ones") {
  Random r(72);
  std::set<int> seen;
  for (int i = 0; i < scaled(80); ++i) {
    const auto a = stone(r), b = i % 3 ? stone(r) : block({0.5, 0.3, 0.8});
    const Pose pa{draw_vec(r), draw_turn(r)}, pb{pa.x + 2.4 * draw_vec(r), draw_turn(r)};
    const MicroscopeRecording recording = find_microscope("v_clip")->record(slide_of(a, pa, b, pb));
    check_steps(recording);
    std::vector<ClosestFeatures> trace;
    VClipOptions options;
    options.trace = &trace;
    const PlacedPolyhedron A(*a->convex()->voronoi(), Pose{Vec3::Zero(), pa.q});
    const PlacedPolyhedron B(*b->convex()->voronoi(), Pose{pb.x - pa.x, pb.q});
    const VClipResult plain = v_clip(A, B, options);
    CHECK(recording.answer == plain.distance);
    if (plain.steps == 0) continue;
    REQUIRE(recording.steps.size() == trace.size());
    for (size_t k = 0; k < trace.size(); ++k) {
      const MicroscopeStep& step = recording.steps[k];
      CHECK(step.title.find(feature_text(trace[k][0], 0)) != std::string::npos);
      CHECK(step.title.find(feature_text(trace[k][1], 1)) != std::string::npos);
      if (k + 1 == trace.size()) continue;
      const auto move = v_clip_move(trace[k], trace[k + 1]);
      REQUIRE(move.has_value());
      CHECK(move->number >= 1);
      CHECK(step.caption.find(move->sentence) != std::string::npos);
      seen.insert(move->number);
    }
    if (plain.state == VClipState::separated && plain.answer == VClipAnswer::walk)
      CHECK(recording.steps.back().caption.find("closest features") != std::string::npos);
  }
  if (scaled(80) >= 80) CHECK(seen.size() >= 8);  // most of the twelve that go on
}

TEST_CASE("the steps to a contact end at the time of contact") {
  Random r(73);
  int hits = 0;
  for (int i = 0; i < scaled(40); ++i) {
    const auto a = i % 2 ? block({0.6, 0.1, 0.3}) : round_shape(ShapeType::cylinder, 0.3);
    const bool ground = i % 4 == 3;
    ShapeDef plane;
    plane.type = ShapeType::half_space;
    const auto b = ground ? made(plane) : stone(r);
    const Pose pb =
        ground ? Pose{Vec3(0, -2, 0), Quat::Identity()} : Pose{draw_vec(r), draw_turn(r)};
    MicroscopeSlide slide = slide_of(a, {Vec3(-4, 1, 0) + draw_vec(r), draw_turn(r)}, b, pb);
    slide.body[0].motion.velocity = Vec3(6, -2, 0) + draw_vec(r);
    slide.body[0].motion.omega = 4 * draw_vec(r);
    if (i % 5 == 4) std::swap(slide.body[0], slide.body[1]);
    const MicroscopeRecording recording = find_microscope("time_of_contact")->record(slide);
    check_steps(recording);
    const Specimen &one = slide.body[0], &two = slide.body[1];
    const TimeOfContact plain =
        time_of_contact(*one.shape, one.motion, *two.shape, two.motion, slide.tolerance);
    if (plain.hit()) {
      ++hits;
      CHECK(std::abs(recording.answer - plain.time) < 1e-3);
      CHECK(recording.steps.back().title == "The contact is bracketed");
    } else {
      CHECK(std::isinf(recording.answer));
    }
  }
  if (scaled(40) >= 40) CHECK(hits > 10);
}

TEST_CASE("what cannot be looked at is refused with a reason") {
  TestWorld w;
  BodyDef two = TestWorld::sphere_def({0, 0, 0});
  two.shapes.push_back(two.shapes.front());
  const BodyId pair = w.add(two), one = w.add(TestWorld::sphere_def({5, 0, 0}));
  const BodyId other = w.add(TestWorld::box_def({8, 0, 0}));
  const Frame& frame = *w.world->frame();
  MicroscopeSetup setup;
  setup.a = one;
  setup.b = other;
  CHECK(microscope_refusal(frame, setup) == "");
  setup.algorithm = "v_clip";
  CHECK(microscope_refusal(frame, setup).find("polyhedra") != std::string::npos);
  setup.algorithm = "gkj";
  CHECK(microscope_refusal(frame, setup).find("did you mean 'gjk'") != std::string::npos);
  setup.algorithm = "gjk";
  setup.b = pair;
  CHECK(microscope_refusal(frame, setup).find("2 shapes") != std::string::npos);
  setup.b = setup.a;
  CHECK(microscope_refusal(frame, setup).find("itself") != std::string::npos);
  setup.b = BodyId{99, 1};
  CHECK(microscope_refusal(frame, setup).find("gone") != std::string::npos);
}

TEST_CASE("steps come due with the time") {
  MicroscopeSetup setup;
  setup.step = 2;
  CHECK(setup.step_at(10) == 2);
  setup.steps_per_second = 1.5;
  CHECK(setup.step_at(0) == 2);
  CHECK(setup.step_at(0.66) == 2);
  CHECK(setup.step_at(2.0 / 3) == 3);
  CHECK(setup.step_at(2) == 5);
}
