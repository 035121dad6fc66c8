// What is drawn over the bodies. Reference: counts and places worked out by hand from frames built
// in the test ("a point, a normal and an arrow").
#include "engine/core/random.hpp"
#include "engine/scene/description.hpp"
#include "engine/scene/visitors/known_names.hpp"
#include "tests/viewer/extract/frame_maker.hpp"
#include "viewer/app/scenes/scene_look.hpp"
#include "viewer/render/extract_vectors.hpp"
#include "viewer/render/scene_scales.hpp"

#include <limits>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("contacts: a point, a normal and an arrow of two meshes each") {
  FrameMaker m;
  m.add(shape(ShapeType::sphere), {0, 0.5, 0});
  for (int i = 0; i < 4; ++i) {
    ContactFrame c;
    c.x_world = Vec3(i, 0, 0);
    c.normal = Vec3::UnitY();
    c.gap = i == 0 ? -0.001 : 0.001;
    c.impulse = Vec3(0, 9.81 / 60, 0);
    m.contacts.push_back(c);
  }
  const Frame frame = m.make();
  Overlays o;
  o.contacts = true;
  RenderScene scene = extracted(frame, o);
  REQUIRE(scene.points.size() == 4);
  CHECK((scene.points[0].colour != scene.points[1].colour));
  CHECK(scene.instances.size() == 1);
  o = {};
  o.normals = true;
  scene = extracted(frame, o);
  REQUIRE(scene.lines.size() == 4);
  CHECK(scene.lines[2].b.y() > scene.lines[2].a.y());
  o = {};
  o.forces = true;
  CHECK(extracted(frame, o).instances.size() == 1 + 4 * 2);
}

TEST_CASE("contacts of particles: a point and a normal each") {
  FrameMaker m;
  m.add(shape(ShapeType::sphere), {0, 0.5, 0});
  Frame frame = m.make();
  std::vector<ParticleContactFrame> touched(3);
  touched[1].gap = -0.01;
  touched[2].apart_again = true;
  frame.particle_contacts =
      std::make_shared<const std::vector<ParticleContactFrame>>(std::move(touched));
  Overlays o;
  o.contacts = true;
  const RenderScene scene = extracted(frame, o);
  REQUIRE(scene.points.size() == 3);
  CHECK((scene.points[1].colour != scene.points[0].colour));
  CHECK(scene.lines.empty());
  o.normals = true;
  CHECK(extracted(frame, o).lines.size() == 3);
}

TEST_CASE("bounds are twelve lines a body, none for what is infinite") {
  FrameMaker m;
  m.add(shape(ShapeType::box), {0, 0, 0});
  m.add(shape(ShapeType::sphere), {3, 0, 0});
  m.add(shape(ShapeType::half_space), {0, -1, 0}, BodyType::fixed);
  Overlays o;
  o.aabbs = true;
  const RenderScene scene = extracted(m.make(), o);
  CHECK(scene.lines.size() == 24);
  float highest = 0;
  for (const LineSegment& l : scene.lines) highest = std::max(highest, l.a.x());
  CHECK(highest == doctest::Approx(3.5));
}

TEST_CASE("the grid of a frame is that of its broad phase: brute force has none") {
  FrameMaker m;
  for (int i = 0; i < 20; ++i) m.add(shape(ShapeType::box), {2.0 * i, 0, 0});
  m.add(shape(ShapeType::half_space), {0, -1, 0}, BodyType::fixed);
  Overlays o;
  o.grid = true;
  Frame frame = m.make();
  for (const char* name : {"uniform_grid", "multi_level_grid", "aabb_tree", "brute_force"}) {
    CAPTURE(name);
    frame.broad_phase = name;
    const size_t lines = extracted(frame, o).lines.size();
    CHECK(lines % 12 == 0);
    CHECK((lines > 0) == (frame.broad_phase != "brute_force"));
  }
}

TEST_CASE("wires of a tetrahedron are its six edges, of a box twelve") {
  FrameMaker m;
  m.add(shape(ShapeType::triangle_mesh, tetrahedron()), {0, 0, 0});
  Overlays o;
  o.collision_shape = true;
  CHECK(extracted(m.make(), o).lines.size() == 6);
  FrameMaker b;
  b.add(shape(ShapeType::box), {0, 0, 0});
  CHECK(extracted(b.make(), o).lines.size() == 12);
}

TEST_CASE("velocities are arrows of the moving bodies only") {
  FrameMaker m;
  m.add(shape(ShapeType::sphere), {0, 0, 0});
  m.bodies[m.add(shape(ShapeType::sphere), {3, 0, 0})].v = Vec3(4, 0, 0);
  Overlays o;
  o.velocities = true;
  CHECK(extracted(m.make(), o).instances.size() == 2 + 2);
}

TEST_CASE("total forces are changes of momentum, momenta masses times velocities, to one scale") {
  FrameMaker m;
  for (int i = 0; i < 3; ++i) m.add(shape(ShapeType::sphere), {3.0 * i, 0, 0});
  m.add(shape(ShapeType::sphere), {0, 5, 0}, BodyType::kinematic);
  m.infos[1].mass = 2;
  m.frame.stats.bodies = 4;
  Frame before = m.make();
  before.tick = 7;
  // Falling for a tick; pushed by 30 N; put elsewhere; moved by its course.
  const double tick = before.rate.tick();
  m.bodies[0].v = Vec3(0, -9.81 * tick, 0);
  m.bodies[1].v = Vec3(15 * tick, 0, 0);
  m.bodies[2].v = Vec3(100, 0, 0);
  m.bodies[2].jumped = true;
  m.bodies[3].v = Vec3(1, 0, 0);
  Frame now = m.make();
  now.tick = 8;
  CHECK(mean_total_force(before, now, 0)->isApprox(Vec3(0, -9.81, 0), 1e-12));
  CHECK(mean_total_force(before, now, 1)->isApprox(Vec3(30, 0, 0), 1e-12));
  CHECK_FALSE(mean_total_force(before, now, 2));
  CHECK_FALSE(mean_total_force(before, now, 3));
  CHECK_FALSE(mean_total_force(now, now, 0));
  ExtractOptions options;
  options.overlays.total_forces = true;
  // Bodies of 1 kg and half a metre: a newton is .1 m, as 9.81 N is to be about 1.5 radii.
  const double newtons = vector_scales(now, options.overlays).force;
  CHECK(newtons == 20);
  CHECK(force_scale_words(now, options.overlays) == "1 m is 20 N");
  // Gravity that passes zero on its course changes no scale.
  Frame floating = now;
  floating.gravity = Vec3(0, -1e-9, 0);
  CHECK(vector_scales(floating, options.overlays).force == newtons);
  const RenderScene forces = extracted(before, now, 1, options);
  REQUIRE(forces.lines.size() == 2);
  CHECK(double((forces.lines[1].b - forces.lines[1].a).x()) == doctest::Approx(30 / newtons));
  // The moment before is not known, or was given.
  CHECK(extracted(now, now, 1, options).lines.empty());
  options.before = std::make_shared<const Frame>(before);
  CHECK(extracted(now, now, 1, options).lines.size() == 2);
  options.overlays.total_forces = false;
  options.overlays.momenta = true;
  options.overlays.vector_length = 2;
  const RenderScene momenta = extracted(now, now, 1, options);
  const double scale = vector_scales(now, options.overlays).momentum;
  CHECK(scale == 2.5);                  // twice as long as 5 kg m/s a metre
  REQUIRE(momenta.points.size() == 3);  // the tip of each, or its dot; none of what has a course
  // What is longer than twelve sizes ends there, in a dot.
  const LineSegment& longest = momenta.lines.back();
  CHECK(double((longest.b - longest.a).norm()) == doctest::Approx(12 * 0.5).epsilon(1e-5));
}

TEST_CASE("velocities of particles are lines along what they have moved, also over a seam") {
  FrameMaker m;
  const auto system = [](std::vector<uint64_t> ids, std::vector<Vec3> x) {
    auto out = std::make_shared<ParticleFrame>();
    out->ids = std::move(ids);
    out->x = std::move(x);
    out->radius.assign(out->x.size(), 0.1);
    out->colour.assign(out->x.size(), Vec3f::Zero());
    out->box.size = Vec3(10, 0, 0);
    return out;
  };
  Frame before = m.make();
  before.particles = {system({1, 2, 5}, {{0, 0, 0}, {4.9, 0, 0}, {0, 1, 0}})};
  Frame now = m.make();
  now.tick = before.tick + 1;
  now.particles = {system({1, 5, 6}, {{0, 0.1, 0}, {0, 1, 0.2}, {3, 3, 3}})};
  ExtractOptions options;
  options.overlays.velocities = true;
  RenderScene scene = extracted(before, now, 1, options);
  REQUIRE(scene.lines.size() == 2);
  const double shown = 0.25 / now.rate.tick();
  CHECK(double((scene.lines[0].b - scene.lines[0].a).y()) == doctest::Approx(0.1 * shown));
  now.particles = {system({2}, {{-4.9, 0, 0}})};
  scene = extracted(before, now, 1, options);
  REQUIRE(scene.lines.size() == 1);
  CHECK(double((scene.lines[0].b - scene.lines[0].a).x()) == doctest::Approx(0.2 * shown));
}

TEST_CASE("momenta of particles have a scale of their own, and no more arrows than can be read") {
  FrameMaker m;
  const auto system = [](size_t count, double y) {
    auto out = std::make_shared<ParticleFrame>();
    for (size_t i = 0; i < count; ++i) {
      out->ids.push_back(i);
      out->x.emplace_back(double(i), y, 0);
      out->mass.push_back(i == 1 ? 0.004 : 0.002);
    }
    out->radius.assign(count, 0.1);
    out->colour.assign(count, Vec3f::Zero());
    return out;
  };
  Frame before = m.make(), now = m.make();
  now.tick = before.tick + 1;
  const double rise = 4 * now.rate.tick();  // 4 m/s
  before.particles = {system(2, 0)};
  now.particles = {system(2, rise)};
  ExtractOptions options;
  options.overlays.momenta = true;
  // 4 m/s of a body of 2 g are .008 kg m/s, rounded up to 1, 2 or 5 of a decade.
  CHECK(vector_scales(now, options.overlays).particle_momentum == doctest::Approx(0.01));
  CHECK(particle_momentum_scale(now, options.overlays) == "1 m is 0.01 kg m/s");
  RenderScene scene = extracted(before, now, 1, options);
  REQUIRE(scene.lines.size() == 2);
  CHECK(double((scene.lines[0].b - scene.lines[0].a).y()) == doctest::Approx(0.8));
  CHECK(double((scene.lines[1].b - scene.lines[1].a).y()) == doctest::Approx(1.6));
  // Without the tick before nothing moves that is known.
  CHECK(extracted(now, now, 1, options).lines.empty());
  before.particles = {system(2500, 0)};
  now.particles = {system(2500, rise)};
  scene = extracted(before, now, 1, options);
  CHECK(scene.lines.size() == 834);  // ids 0, 3, ... 2499
  CHECK(particle_momentum_scale(now, options.overlays).ends_with("; 834 of 2500 are drawn"));
  CHECK(particle_velocity_scale(now, options.overlays) == "1 m is 4 m/s; 834 of 2500 are drawn");
}

TEST_CASE("islands: the same number has the same colour, sleeping is darker") {
  FrameMaker m;
  for (int i = 0; i < 4; ++i) m.add(shape(ShapeType::sphere), {double(i), 0, 0});
  m.bodies[0].island = m.bodies[1].island = 1;
  m.bodies[2].island = 2;
  m.bodies[3].island = 1;
  m.bodies[3].asleep = true;
  Overlays o;
  o.islands = true;
  const RenderScene scene = extracted(m.make(), o);
  const auto colour = [&](size_t i) { return scene.instances[i].paint.colour; };
  CHECK(colour(0) == colour(1));
  CHECK(colour(0) != colour(2));
  CHECK(colour(3).sum() < colour(0).sum());
}

TEST_CASE("springs are drawn always, their anchors on demand") {
  FrameMaker m;
  ForceFrame spring;
  spring.def = SpringDef{};
  spring.points = {Vec3(0, 0, 0), Vec3(0, 2, 0)};
  m.frame.forces = {spring};
  RenderScene scene = extracted(m.make(), Overlays{});
  REQUIRE(scene.lines.size() > 10);
  CHECK(scene.lines.front().a.y() == 0);
  CHECK(scene.lines.back().b.y() == 2);
  CHECK(scene.points.empty());
  Overlays o;
  o.joints = true;
  CHECK(extracted(m.make(), o).points.size() == 2);
}

TEST_CASE("overlays are found by name") {
  const auto some = parse_overlays("contacts,islands");
  REQUIRE(some.ok());
  CHECK(some->contacts);
  CHECK(some->islands);
  CHECK_FALSE(some->aabbs);
  CHECK(parse_overlays("").ok());
  for (const OverlayEntry& entry : all_overlays()) {
    const auto one = parse_overlays(entry.name);
    REQUIRE(one.ok());
    CHECK((*one).*(entry.enabled));
  }
  const auto tree = parse_overlays("aabbs,hierarchy:obb:5");
  REQUIRE(tree.ok());
  CHECK(tree->aabbs);
  CHECK(tree->hierarchy);
  CHECK(tree->hierarchy_kind == "obb");
  CHECK(tree->hierarchy_level == 5);
  CHECK(parse_overlays("hierarchy:0")->hierarchy_level == 0);
  CHECK(parse_overlays("hierarchy:sphere")->hierarchy_kind == "sphere");
  for (const char* bad : {"hierarchy:-1", "hierarchy:cube", "hierarchy:brute_force", "hierarchy:1x",
                          "hierarchy:99999", "contacts:2", "hierarchy::3"})
    CHECK_FALSE_MESSAGE(parse_overlays(bad).ok(), bad);
  const auto wrong = parse_overlays("contcts");
  REQUIRE_FALSE(wrong.ok());
  CHECK(wrong.error().message.find("contacts") != std::string::npos);
}

TEST_CASE("scenes name the overlays that there are, and those are on") {
  std::vector<std::string> names;
  for (const OverlayEntry& entry : all_overlays()) names.emplace_back(entry.name);
  CHECK(known_names("overlays") == names);
  SceneDescription scene;
  scene.look.overlays = {"forces", "joints"};
  const Overlays on = overlays_of(scene);
  for (const OverlayEntry& entry : all_overlays()) {
    const bool named = entry.name == "forces" || entry.name == "joints";
    CHECK_MESSAGE(on.*entry.enabled == named, entry.name);
  }
}

TEST_CASE("arrows: the force that is in the middle of all is shorter than a body, in any unit") {
  for (const double unit : {1e-6, 1.0, 1e6}) {
    FrameMaker m;
    m.add(shape(ShapeType::sphere), {0, 0.5, 0});
    for (const double force : {0.5, 1.0, 1.0, 2.0, 1e4}) {
      ContactFrame c;
      c.x_world = Vec3::Zero();
      c.normal = Vec3::UnitY();
      c.gap = 0;
      c.impulse = Vec3(0, force * unit, 0);
      m.contacts.push_back(c);
    }
    Overlays o;
    o.forces = true;
    const RenderScene scene = extracted(m.make(), o);
    REQUIRE(scene.lines.size() == 5);
    const double radius = m.infos[0].shapes[0].shape->bounding_radius();
    const auto length = [&](size_t i) { return double(scene.lines[i].b.y()) / radius; };
    CHECK(length(0) == doctest::Approx(0.4));
    CHECK(length(1) == doctest::Approx(0.8));
    CHECK(length(3) == doctest::Approx(0.8 * (1 + std::log(2))));
    CHECK(length(4) < 10);
  }
}

TEST_CASE("a net of very many springs is drawn with a line for each") {
  FrameMaker m;
  ForceFrame spring;
  spring.def = SpringDef{};
  spring.points = {Vec3(0, 0, 0), Vec3(0, 2, 0)};
  m.frame.forces.assign(100, spring);
  const size_t coils = extracted(m.make(), Overlays{}).lines.size();
  CHECK(coils > 100 * 20);
  m.frame.forces.assign(50000, spring);
  CHECK(extracted(m.make(), Overlays{}).lines.size() == 50000);
}

TEST_CASE("what is not finite or has flown away sets no scale") {
  const auto box = [](const Vec3& x, double half) {
    return Aabb{x.array() - half, x.array() + half};
  };
  std::vector<Aabb> pile;
  for (int i = 0; i < 50; ++i) pile.push_back(box(Vec3(i % 5, i / 5, 0), 0.5));
  Aabb all;
  for (const Aabb& b : pile) all.include(b);
  for (const double far : {1e4, 1e6, 1e18, 1e300, std::numeric_limits<double>::infinity()}) {
    auto boxes = pile;
    boxes.insert(boxes.begin(), box(Vec3(far, 0, -far), 0.5));
    boxes.insert(boxes.begin() + 20, box(Vec3(0, 0, 0), far));
    const Aabb most = bounds_of_most(boxes);
    CHECK(most.min == all.min);
    CHECK(most.max == all.max);
  }
  pile.push_back(box(Vec3(100, 0, 0), 0.5));  // a stone's throw away is not gone
  CHECK(bounds_of_most(pile).max.x() == 100.5);
  CHECK(bounds_of_most({}).empty());

  FrameMaker m;
  m.add(shape(ShapeType::sphere), {0, 1, 0});
  m.add(shape(ShapeType::sphere), {2, 1, 0});
  const Aabb home = interesting_bounds(m.make());
  CHECK(home.max.x() > 2);
  for (const size_t gone : {0u, 1u}) {
    FrameMaker later = m;
    later.bodies[gone].pose.x = Vec3(1e6, 5e5, 0);
    const Aabb seen = interesting_bounds(later.make(), home);
    CHECK(seen.extent().norm() < 10);
    CHECK(seen.contains(m.bodies[1 - gone].pose.x));
  }
}

TEST_CASE("arrows of fields are few, along the field where they stand, and none reaches the next") {
  for (const double size : {0.01, 1.0, 300.0}) {
    CAPTURE(size);
    FrameMaker m;
    Random random(5);
    for (int i = 0; i < 500; ++i)
      m.add(shape(ShapeType::sphere),
            size * Vec3(random.uniform(-4, 4), random.uniform(-1, 1), random.uniform(-4, 4)));
    VortexDef vortex;
    vortex.core_radius = size;
    ForceFrame force;
    force.def = vortex;
    m.frame.forces.push_back(force);
    const Frame frame = m.make();
    RenderScene out;
    std::vector<Pose> poses(frame.body_slots());
    for (size_t i = 0; i < poses.size(); ++i) poses[i] = frame.body(i).pose;
    add_fields(frame, poses, out);
    // A shaft and a head each.
    REQUIRE(out.instances.size() % 2 == 0);
    CHECK(out.instances.size() / 2 >= 20);
    CHECK(out.instances.size() / 2 <= 100);
    double nearest = std::numeric_limits<double>::infinity(), longest = 0;
    std::vector<Vec3> middles;
    for (size_t i = 0; i < out.instances.size(); i += 2) {
      const auto& shaft = out.instances[i].transform;
      const auto& head = out.instances[i + 1].transform;
      const Vec3 along = 2 * (head.offset - shaft.offset).cast<double>();  // without the head
      const Vec3 tip = (head.offset + head.linear * Vec3f::UnitY()).cast<double>();
      const Vec3 tail = shaft.offset.cast<double>() - 0.5 * along;
      const Vec3 middle = 0.5 * (tip + tail);
      const auto flow = sample_field(vortex, middle, 0);
      REQUIRE(flow);
      CHECK(along.normalized().dot(flow->value.normalized()) > 0.9999);
      longest = std::max(longest, (tip - tail).norm());
      for (const Vec3& other : middles) nearest = std::min(nearest, (other - middle).norm());
      middles.push_back(middle);
    }
    CHECK(longest < nearest);
    CHECK(longest > 0.3 * nearest);
  }
}
