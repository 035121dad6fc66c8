// Reference: Coulomb's law. On a slope of 25 degrees, blocks with less friction than tan 25 = 0.466
// slide with their force on the cone, those with more stick with their force inside it. Angles are
// measured from the lines that are drawn.
#include "viewer/render/friction_cones.hpp"

#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"
#include "viewer/render/extract.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr size_t lines_of_cone = 16 + 4 + 1;

/// Three blocks on level ground under tilted gravity. The ground has friction 1, and of two
/// surfaces sqrt(a b) counts.
std::shared_ptr<const Frame> blocks_on_slope() {
  const SceneRead read = read_scene(R"json({"tumble_scene": 1,
    "settings": {"gravity": ["= 9.81*sin_deg(25)", "= -9.81*cos_deg(25)", 0]},
    "bodies": {
      "ground": {"type": "static", "shape": {"type": "half_space"},
                 "material": {"friction": 1, "restitution": 0}},
      "ice": {"shape": {"type": "box", "size": [1, 0.2, 1]}, "position": [0, 0.1, -2],
              "material": {"friction": 0, "restitution": 0}},
      "slider": {"shape": {"type": "box", "size": [1, 0.2, 1]}, "position": [0, 0.1, 0],
                 "material": {"friction": "= 0.3^2", "restitution": 0}},
      "sticker": {"shape": {"type": "box", "size": [1, 0.2, 1]}, "position": [0, 0.1, 2],
                  "material": {"friction": "= 0.6^2", "restitution": 0}}}})json",
                                    "slope.json");
  REQUIRE(read.ok());
  auto built = build_world(read.scene);
  REQUIRE(built.ok());
  for (int i = 0; i < 30; ++i) REQUIRE(built->world->step().ok());
  return built->world->frame();
}

BodyId body_named(const Frame& frame, std::string_view name) {
  for (size_t slot = 0; slot < frame.body_slots(); ++slot)
    if (frame.info(slot).name == name) return frame.body(slot).id;
  FAIL("no body of this name");
  return {};
}

RenderScene cones_of(const Frame& frame, std::string_view name) {
  RenderScene out;
  add_friction_cones(frame, name.empty() ? BodyId{} : body_named(frame, name), out);
  return out;
}

double degrees_between(const Vec3f& a, const Vec3& b) {
  const Vec3 u = a.cast<double>();
  return std::atan2(u.cross(b).norm(), u.dot(b)) * 180 / M_PI;
}

}  // namespace

TEST_CASE("friction cones: the opening is the coefficient, the force is inside or on the cone") {
  const auto frame = blocks_on_slope();
  for (const auto& [name, friction] : {std::pair{"slider", 0.3}, {"sticker", 0.6}}) {
    const auto& shown_name = name;
    CAPTURE(shown_name);
    const bool slides = friction < std::tan(25 * M_PI / 180);
    const RenderScene scene = cones_of(*frame, name);
    REQUIRE(scene.lines.size() == 4 * lines_of_cone);
    const double opening = std::atan(friction) * 180 / M_PI;
    const float slant = (scene.lines[16].b - scene.lines[16].a).norm();
    const Vec4f force_colour = scene.lines[20].colour;
    if (slides) CHECK(force_colour.x() > force_colour.y());
    int inside = 0;  // of what sticks single points may be at their limit: the load is shared
    for (size_t k = 0; k < 4; ++k) {
      const LineSegment* cone = &scene.lines[k * lines_of_cone];
      const Vec3f tip = cone[16].a;
      for (int i = 0; i < 16; ++i)
        CHECK(degrees_between(cone[i].a - tip, Vec3::UnitY()) ==
              doctest::Approx(opening).epsilon(1e-4));
      for (int i = 16; i < 20; ++i) {
        CHECK((cone[i].a - tip).norm() == 0);
        CHECK((cone[i].b - tip).norm() == doctest::Approx(slant));
      }
      const LineSegment& force = cone[20];
      CHECK((force.a - tip).norm() == 0);
      CHECK(force.b.y() == doctest::Approx(cone[0].a.y()));
      if (slides) CHECK(force.colour == force_colour);
      inside += force.colour.y() > force.colour.x();
      const double leans = degrees_between(force.b - tip, Vec3::UnitY());
      CHECK(leans <= opening + 1e-3);
      if (slides) {
        CHECK(leans == doctest::Approx(opening).epsilon(1e-4));
        // Against the motion, which is downhill.
        CHECK(force.b.x() < tip.x());
      }
    }
    CHECK((slides ? inside == 0 : inside > 0));
  }
}

TEST_CASE("friction cones: a frictionless contact has its force alone, along the normal") {
  const RenderScene scene = cones_of(*blocks_on_slope(), "ice");
  REQUIRE(scene.lines.size() == 4);
  for (const LineSegment& l : scene.lines) CHECK(degrees_between(l.b - l.a, Vec3::UnitY()) < 1e-3);
}

TEST_CASE("friction cones: of the selected body over everything, else of all and faint inside") {
  const auto frame = blocks_on_slope();
  CHECK(cones_of(*frame, "").lines.size() == 8 * lines_of_cone + 4);
  for (const LineSegment& l : cones_of(*frame, "").lines) CHECK(l.occlusion == Occlusion::faint);
  for (const LineSegment& l : cones_of(*frame, "slider").lines)
    CHECK(l.occlusion == Occlusion::none);
  CHECK(cones_of(*frame, "ground").lines.size() == 8 * lines_of_cone + 4);
  // The overlay is that, and nothing without it.
  ExtractOptions options;
  options.selected = body_named(*frame, "sticker");
  ShapeMeshes meshes;
  RenderScene out;
  extract(*frame, *frame, 1, options, meshes, out);
  CHECK(out.lines.empty());
  options.overlays.friction_cones = true;
  extract(*frame, *frame, 1, options, meshes, out);
  CHECK(out.lines.size() == 4 * lines_of_cone);
}

TEST_CASE("friction cones: bodies that do not press have none") {
  ContactFrame c;
  c.x_world = Vec3::Zero();
  c.gap = 0;
  c.normal = Vec3::UnitY();
  c.friction = 0.5;
  c.impulse = Vec3::Zero();
  CHECK(grip_of(c) == ContactGrip::none);
  c.impulse = Vec3(0.2, 1, 0);
  CHECK(grip_of(c) == ContactGrip::stick);
  c.impulse = Vec3(0.3, 1, -0.4);
  CHECK(grip_of(c) == ContactGrip::slide);
  c.impulse = Vec3(5, 0.001, 0);
  CHECK(grip_of(c) == ContactGrip::slide);
  Frame frame = *blocks_on_slope();
  auto outside = std::make_shared<std::vector<ContactFrame>>(1, c);
  frame.contacts = outside;
  const RenderScene one = cones_of(frame, "");
  REQUIRE(one.lines.size() == lines_of_cone);
  // A force outside its cone is drawn where it is, no longer than the cone.
  const float slant = (one.lines[16].b - one.lines[16].a).norm();
  CHECK((one.lines[20].b - one.lines[20].a).norm() == doctest::Approx(slant));
  CHECK(degrees_between(one.lines[20].b - one.lines[20].a, Vec3::UnitX()) < 0.1);
  auto contacts = std::make_shared<std::vector<ContactFrame>>(*frame.contacts);
  for (ContactFrame& contact : *contacts) contact.impulse = Vec3::Zero();
  frame.contacts = contacts;
  CHECK(cones_of(frame, "").lines.empty());
}
