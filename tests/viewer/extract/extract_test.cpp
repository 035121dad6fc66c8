// Reference: counts and places worked out by hand from frames built in the test ("three meshes,
// four arrows"); no GL and no world is involved.
#include "viewer/render/extract.hpp"

#include "engine/collision/shape.hpp"
#include "engine/math/rotation.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/visitors/known_names.hpp"
#include "tests/support/ring_mesh.hpp"
#include "tests/support/shape_reference.hpp"
#include "viewer/app/scene_look.hpp"
#include "viewer/render/scene_scales.hpp"
#include "viewer/render/trails.hpp"

#include <doctest/doctest.h>

using namespace tumble;

namespace {

std::shared_ptr<const Shape> shape(ShapeType type, std::shared_ptr<const TriangleMesh> mesh = {}) {
  ShapeDef def;
  def.type = type;
  def.mesh = std::move(mesh);
  auto made = make_shape(def);
  REQUIRE(made.ok());
  return *made;
}

std::shared_ptr<const TriangleMesh> tetrahedron() {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

/// A frame that the test fills body by body.
struct FrameMaker {
  std::vector<BodyInfo> infos;
  std::vector<BodyFrame> bodies;
  std::vector<ContactFrame> contacts;
  Frame frame;

  size_t add(const std::shared_ptr<const Shape>& part, const Vec3& x,
             BodyType type = BodyType::dynamic) {
    BodyFrame body;
    body.id = {uint32_t(bodies.size()), 1};
    body.pose.x = x;
    BodyInfo info;
    info.id = body.id;
    info.type = type;
    info.mass = 1;
    BodyShape placed;
    placed.shape = part;
    info.shapes.push_back(placed);
    bodies.push_back(body);
    infos.push_back(info);
    return bodies.size() - 1;
  }

  Frame make() {
    Frame f = frame;
    f.gravity = Vec3(0, -9.81, 0);
    f.infos = std::make_shared<std::vector<BodyInfo>>(infos);
    f.contacts = std::make_shared<std::vector<ContactFrame>>(contacts);
    f.chunks.clear();
    for (size_t i = 0; i < bodies.size(); i += Frame::chunk_size) {
      auto chunk = std::make_shared<Frame::BodyChunk>();
      for (size_t k = 0; k < Frame::chunk_size && i + k < bodies.size(); ++k)
        (*chunk)[k] = bodies[i + k];
      f.chunks.push_back(chunk);
    }
    return f;
  }
};

RenderScene extracted(const Frame& from, const Frame& to, double s, ExtractOptions options = {}) {
  ShapeMeshes meshes;
  RenderScene out;
  extract(from, to, s, options, meshes, out);
  return out;
}

RenderScene extracted(const Frame& frame, const Overlays& overlays) {
  ExtractOptions options;
  options.overlays = overlays;
  return extracted(frame, frame, 1, options);
}

}  // namespace

TEST_CASE("every body becomes one mesh, a level half-space only the ground") {
  FrameMaker m;
  m.add(shape(ShapeType::sphere), {0, 1, 0});
  m.add(shape(ShapeType::box), {1, 1, 0});
  m.add(shape(ShapeType::capsule), {2, 1, 0});
  m.add(shape(ShapeType::cylinder), {3, 1, 0});
  m.add(shape(ShapeType::convex_hull, tetrahedron()), {4, 1, 0});
  m.add(shape(ShapeType::triangle_mesh, tetrahedron()), {5, 1, 0});
  m.add(shape(ShapeType::ellipsoid), {6, 1, 0});
  m.add(shape(ShapeType::half_space), {0, -0.25, 0}, BodyType::fixed);
  const Frame frame = m.make();
  const RenderScene scene = extracted(frame, frame, 1);
  REQUIRE(scene.instances.size() == 7);
  CHECK(scene.ground.height == -0.25);
  for (size_t i = 0; i < 7; ++i)
    CHECK((scene.instances[i].transform.offset - Vec3f(float(i), 1, 0)).norm() < 1e-6);
  CHECK(scene.instances[5].mesh->indices.size() == 12);
  CHECK(scene.lines.empty());
  CHECK(scene.points.empty());
}

TEST_CASE("what is drawn of every listed shape lies on its surface and reaches round it") {
  // Reference: the second definition of each shape. Corners of the triangles of round surfaces
  // stand out by less than four thousandths of the size, so that the triangles are about as large
  // as these.
  Random r(78);
  const Pose pose{{1, 2, 3}, axis_angle(Vec3(1, 2, -1).normalized(), 0.8)};
  for (const ShapeEntry& entry : all_shapes()) {
    if (entry.family != ShapeFamily::convex || entry.parameters.empty()) continue;
    CAPTURE(entry.name);
    const ShapeDef def = test::draw_def(r, entry);
    ShapeMeshes meshes;
    RenderScene out;
    add_shape(*make_shape(def), pose, {}, false, meshes, out);
    REQUIRE(out.instances.size() == 1);
    const MeshInstance& drawn = out.instances[0];
    std::vector<Vec3> points;
    for (size_t i = 0; i < drawn.mesh->positions.size(); ++i) {
      const Vec3f n = (drawn.transform.linear * drawn.mesh->normals[i]).normalized();
      const Vec3f x = drawn.transform.linear * drawn.mesh->positions[i] + drawn.transform.offset;
      points.push_back(pose.inverse_point((x + drawn.inflate * n).cast<double>()));
    }
    double size = 0;
    for (const Vec3& p : points) size = std::max(size, p.norm());
    if (def.type == ShapeType::ellipsoid) size = 1;  // whose level is a ratio
    for (const Vec3& p : points) CHECK(test::level(def, p) < 4e-3 * size);
    for (int k = 0; k < 6; ++k) {
      const Vec3 n = (k % 2 ? -1 : 1) * Vec3::Unit(k / 2);
      double reach = -1;
      for (const Vec3& p : points) reach = std::max(reach, n.dot(p));
      CHECK(reach == doctest::Approx(test::extent_along(def, n)).epsilon(0.01));
    }
  }
}

TEST_CASE("a tilted half-space is a plane, an invisible or dead body nothing") {
  FrameMaker m;
  const size_t ramp = m.add(shape(ShapeType::half_space), {0, 0, 0}, BodyType::fixed);
  m.bodies[ramp].pose.q = axis_angle(Vec3::UnitZ(), 0.3);
  m.infos[m.add(shape(ShapeType::sphere), {0, 0, 0})].look.visible = false;
  m.bodies[m.add(shape(ShapeType::sphere), {0, 0, 0})].id = {};
  const Frame frame = m.make();
  CHECK(extracted(frame, frame, 1).instances.size() == 1);
}

TEST_CASE("what is seen through is drawn as much as its look says") {
  FrameMaker m;
  const size_t pane = m.add(shape(ShapeType::box), {0, 0, 0});
  m.infos[pane].look.opacity = 0.25f;
  m.add(shape(ShapeType::box), {0, 0, 3});
  const Frame frame = m.make();
  const RenderScene scene = extracted(frame, frame, 1);
  REQUIRE(scene.instances.size() == 2);
  CHECK(scene.instances[0].paint.opacity == 0.25f);
  CHECK(scene.instances[1].paint.opacity == 1);
}

TEST_CASE("a hundred bodies of one shape share one mesh") {
  FrameMaker m;
  const auto part = shape(ShapeType::triangle_mesh, tetrahedron());
  for (int i = 0; i < 100; ++i) m.add(part, {double(i), 0, 0});
  const Frame frame = m.make();
  ShapeMeshes meshes;
  RenderScene out;
  extract(frame, frame, 1, {}, meshes, out);
  extract(frame, frame, 1, {}, meshes, out);
  CHECK(meshes.size() == 1);
  REQUIRE(out.instances.size() == 100);
  CHECK(out.instances[0].mesh == out.instances[99].mesh);
}

TEST_CASE("meshes of shapes that are gone are forgotten") {
  ShapeMeshes meshes;
  RenderScene out;
  {
    FrameMaker m;
    m.add(shape(ShapeType::triangle_mesh, tetrahedron()), {0, 0, 0});
    const Frame frame = m.make();
    extract(frame, frame, 1, {}, meshes, out);
    meshes.prune();
    CHECK(meshes.size() == 1);
  }
  meshes.prune();
  CHECK(meshes.size() == 0);
}

TEST_CASE("bodies and particles are drawn between two ticks, new ones where they are") {
  FrameMaker m;
  m.add(shape(ShapeType::sphere), {0, 0, 0});
  m.add(shape(ShapeType::sphere), {0, 5, 0});
  auto then = std::make_shared<ParticleFrame>();
  then->x = {{0, 0, 0}};
  then->radius = {0.1};
  then->colour = {Vec3f(1, 0, 0)};
  m.frame.particles = {then};
  const Frame from = m.make();
  m.bodies[0].pose.x = {1, 0, 0};
  m.bodies[1].pose.x = {8, 5, 0};
  m.bodies[1].jumped = true;
  auto now = std::make_shared<ParticleFrame>(*then);
  now->x = {{0, 4, 0}};
  m.frame.particles = {now};
  const Frame to = m.make();
  const RenderScene scene = extracted(from, to, 0.25);
  CHECK(scene.instances[0].transform.offset.x() == doctest::Approx(0.25));
  CHECK(scene.instances[1].transform.offset.x() == doctest::Approx(8));
  REQUIRE(scene.spheres.size() == 1);
  CHECK(scene.spheres[0].centre.y() == doctest::Approx(1));
  CHECK(scene.spheres[0].colour.x() == 1);
}

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

TEST_CASE("hierarchies: twelve lines a box and three circles a sphere, of the level asked for") {
  const auto ring = shape(ShapeType::triangle_mesh,
                          std::make_shared<const TriangleMesh>(ring_mesh(1, 0.3, 32, 16)));
  FrameMaker m;
  m.add(ring, {0, 0, 0});
  m.add(ring, {5, 0, 0});
  m.add(shape(ShapeType::box), {9, 0, 0});
  const Frame frame = m.make();
  ExtractOptions options;
  options.overlays.hierarchy = true;
  for (int level = 0; level < 4; ++level) {
    options.overlays.hierarchy_level = level;
    const size_t volumes = size_t{1} << level;
    for (const char* kind : {"aabb", "obb"}) {
      options.overlays.hierarchy_kind = kind;
      CHECK(extracted(frame, frame, 1, options).lines.size() == 2 * 12 * volumes);
    }
    options.overlays.hierarchy_kind = "sphere";
    CHECK(extracted(frame, frame, 1, options).lines.size() == 2 * 144 * volumes);
    CHECK(extracted(frame, frame, 1, options).instances.size() == 3);
    // Of a selected mesh alone, which is then in the colours of its volumes.
    options.selected = frame.body(1).id;
    const RenderScene one = extracted(frame, frame, 1, options);
    CHECK(one.lines.size() == 144 * volumes);
    CHECK(one.instances.size() == 2 + volumes);
    for (const LineSegment& l : one.lines) CHECK(l.a.x() > 3.0f);
    options.selected = {};
  }
  ShapeMeshes meshes;
  const auto depth = hierarchy_depth(frame, options, meshes);
  REQUIRE(depth.has_value());
  CHECK(*depth >= 7);  // 1024 triangles, four to a leaf
  // Unless a kind is chosen, that of the world; brute force has no volumes.
  options.overlays.hierarchy_kind.clear();
  options.overlays.hierarchy_level = 0;
  for (const auto& [used, lines] :
       {std::pair{"sphere", 144}, {"obb", 12}, {"brute_force", 12}, {"", 12}}) {
    options.world_hierarchy = used;
    CHECK(extracted(frame, frame, 1, options).lines.size() == 2 * size_t(lines));
  }
  options.overlays.hierarchy_kind = "sphere";
  options.overlays.hierarchy_level = *depth + 20;
  CHECK(extracted(frame, frame, 1, options).lines.size() > 2 * 144 * 200);
  options.overlays.hierarchy = false;
  CHECK(extracted(frame, frame, 1, options).lines.empty());
  FrameMaker boxes;
  boxes.add(shape(ShapeType::box), {0, 0, 0});
  CHECK_FALSE(hierarchy_depth(boxes.make(), options, meshes));
}

TEST_CASE("notes of a scene: a label above the body, volumes around it; the overlay goes first") {
  const auto solid = shape(ShapeType::triangle_mesh, tetrahedron());
  FrameMaker m;
  m.add(solid, {0, 2, 0});
  m.add(solid, {4, 2, 0});
  const Frame frame = m.make();
  ExtractOptions options;
  options.notes.push_back({frame.body(0).id, "left", "sphere", 0});
  RenderScene scene = extracted(frame, frame, 1, options);
  REQUIRE(scene.texts.size() == 1);
  CHECK(scene.texts[0].text == "left");
  CHECK(scene.texts[0].x.y() > 3);
  CHECK(scene.texts[0].x.x() == doctest::Approx(0.5));
  CHECK(scene.lines.size() == 144);
  options.overlays.hierarchy = true;
  options.overlays.hierarchy_kind = "obb";
  options.overlays.hierarchy_level = 0;
  CHECK(extracted(frame, frame, 1, options).lines.size() == 24);
  // Of another body: the note stays.
  options.selected = frame.body(1).id;
  CHECK(extracted(frame, frame, 1, options).lines.size() == 144 + 12);
}

TEST_CASE("a scene file gives the notes of its bodies, copies included") {
  const SceneRead read = read_scene(R"({"tumble_scene": 1, "bodies": {
    "plain": {"shape": {"type": "sphere", "radius": 1}},
    "ball": {"shape": {"type": "sphere", "radius": 1}, "look": {"label": "a ball"},
             "position": [9, 0, 0], "repeat": {"type": "stack", "count": 2, "step": [0, 5, 0]}},
    "knot": {"shape": {"type": "triangle_mesh", "mesh": "knot"}, "position": [-9, 0, 0],
             "look": {"volumes": "obb", "volumes_level": 2}}},
    "meshes": {"knot": "trefoil_knot.obj"}})",
                                    "notes.json");
  REQUIRE(read.ok());
  auto built = build_world(read.scene);
  REQUIRE(built.ok());
  ExtractOptions options;
  options.notes = body_notes(*built);
  REQUIRE(options.notes.size() == 3);
  const Frame& frame = *built->world->frame();
  const RenderScene scene = extracted(frame, frame, 1, options);
  CHECK(scene.texts.size() == 2);
  CHECK(scene.lines.size() == 4 * 12);
  for (const char* bad :
       {R"("volumes": "brute_force")", R"("volumes": "cube")", R"("volumes_level": -1)"}) {
    const std::string text = std::string(R"({"tumble_scene": 1, "bodies": {"a": {"shape": {"type":
      "sphere", "radius": 1}, "look": {)") +
                             bad + "}}}}";
    CHECK_FALSE_MESSAGE(build_world(read_scene(text, "bad.json").scene).ok(), bad);
  }
}

TEST_CASE("trees of shapes that are gone are forgotten, and a new shape has its own") {
  ShapeMeshes meshes;
  RenderScene out;
  ExtractOptions options;
  options.overlays.hierarchy = true;
  for (int i = 0; i < 3; ++i) {
    FrameMaker m;
    m.add(shape(ShapeType::triangle_mesh, tetrahedron()), {0, 0, 0});
    const Frame frame = m.make();
    extract(frame, frame, 1, options, meshes, out);
    CHECK(out.lines.size() == 12);
    CHECK(meshes.hierarchies().size() >= 1);
  }
  meshes.prune();
  CHECK(meshes.hierarchies().size() == 0);
}

TEST_CASE("velocities are arrows of the moving bodies only") {
  FrameMaker m;
  m.add(shape(ShapeType::sphere), {0, 0, 0});
  m.bodies[m.add(shape(ShapeType::sphere), {3, 0, 0})].v = Vec3(4, 0, 0);
  Overlays o;
  o.velocities = true;
  CHECK(extracted(m.make(), o).instances.size() == 2 + 2);
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

TEST_CASE("the selected body alone is outlined, and content is replaced each time") {
  FrameMaker m;
  m.add(shape(ShapeType::sphere), {0, 0, 0});
  m.add(shape(ShapeType::sphere), {3, 0, 0});
  const Frame frame = m.make();
  ExtractOptions options;
  options.selected = frame.body(1).id;
  ShapeMeshes meshes;
  RenderScene out;
  out.exposure = 2;
  for (int i = 0; i < 3; ++i) extract(frame, frame, 1, options, meshes, out);
  REQUIRE(out.instances.size() == 2);
  CHECK_FALSE(out.instances[0].selected);
  CHECK(out.instances[1].selected);
  CHECK(out.exposure == 2);
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

namespace {

/// A ball that goes along x with one metre a second, seen at 60 Hz.
Frame moving(FrameMaker& m, uint64_t tick) {
  m.bodies[0].pose.x = Vec3(double(tick) / 60, 1, 0);
  m.frame.tick = tick;
  m.frame.time = double(tick) / 60;
  return m.make();
}

float leftmost(const RenderScene& scene) {
  float x = 1e9f;
  for (const LineSegment& l : scene.lines) x = std::min({x, l.a.x(), l.b.x()});
  return x;
}

}  // namespace

TEST_CASE("trails reach back for their time, to where the body is, and fade") {
  FrameMaker m;
  m.add(shape(ShapeType::sphere), {0, 1, 0});
  m.add(shape(ShapeType::box), {5, 0, 0}, BodyType::fixed);
  Trails trails;
  trails.start(0.5);
  Frame last, now = moving(m, 0);
  trails.see(now);
  for (uint64_t tick = 1; tick <= 90; ++tick) {
    last = now;
    now = moving(m, tick);
    trails.see(now);
  }
  RenderScene scene;
  trails.draw(last, now, 0.5, scene);
  REQUIRE(scene.lines.size() == 31);  // half a second at 60 Hz, begun and ended between two ticks
  CHECK(scene.lines.front().b.x() == doctest::Approx(89.5 / 60));
  CHECK(leftmost(scene) == doctest::Approx(59.0 / 60).epsilon(1e-5));
  for (size_t i = 1; i < scene.lines.size(); ++i) {
    CHECK(scene.lines[i].b == scene.lines[i - 1].a);
    CHECK(scene.lines[i].colour.w() < scene.lines[i - 1].colour.w());
  }

  SUBCASE("going back takes away what came after") {
    m.bodies[0].jumped = true;  // as every body of a world that was put back
    now = moving(m, 70);
    for (int pictures = 0; pictures < 3; ++pictures) trails.see(now);
    m.bodies[0].jumped = false;
    trails.see(moving(m, 71));
    scene.clear_content();
    trails.draw(now, now, 1, scene);
    CHECK(scene.lines.front().b.x() == doctest::Approx(70.0 / 60));
    CHECK(leftmost(scene) == doctest::Approx(59.0 / 60).epsilon(1e-5));
  }
  SUBCASE("a jump ends the path") {
    m.bodies[0].jumped = true;
    now = moving(m, 91);
    trails.see(now);
    m.bodies[0].jumped = false;
    now = moving(m, 92);
    trails.see(now);
    scene.clear_content();
    trails.draw(now, now, 1, scene);
    CHECK(leftmost(scene) == doctest::Approx(91.0 / 60));
  }
  SUBCASE("another body in its place has no path yet") {
    m.bodies[0].id.generation = 2;
    now = moving(m, 91);
    trails.see(now);
    scene.clear_content();
    trails.draw(now, now, 1, scene);
    CHECK(scene.lines.empty());
  }
}

TEST_CASE("trails of many bodies and long times stay few lines, whichever ticks are seen") {
  for (const uint64_t step : {1u, 3u}) {
    FrameMaker m;
    for (int i = 0; i < 3000; ++i) m.add(shape(ShapeType::sphere), {double(i), 1, 0});
    Trails trails;
    trails.start(3600);
    Frame now;
    for (uint64_t tick = 0; tick <= 3000; tick += step * 100) {
      now = moving(m, tick);
      trails.see(now);
    }
    RenderScene scene;
    trails.draw(now, now, 1, scene);
    CHECK(scene.lines.size() <= 60000);
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
  for (const size_t gone : {0, 1}) {
    FrameMaker later = m;
    later.bodies[gone].pose.x = Vec3(1e6, 5e5, 0);
    const Aabb seen = interesting_bounds(later.make(), home);
    CHECK(seen.extent().norm() < 10);
    CHECK(seen.contains(m.bodies[1 - gone].pose.x));
  }
}
