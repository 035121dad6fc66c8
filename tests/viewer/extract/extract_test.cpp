// Reference: counts and places worked out by hand from frames built in the test ("three meshes,
// four arrows"); no GL and no world is involved.
#include "viewer/render/extract.hpp"

#include "engine/collision/shape.hpp"
#include "engine/math/rotation.hpp"

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
  m.add(shape(ShapeType::half_space), {0, -0.25, 0}, BodyType::fixed);
  const Frame frame = m.make();
  const RenderScene scene = extracted(frame, frame, 1);
  REQUIRE(scene.instances.size() == 6);
  CHECK(scene.ground.height == -0.25);
  for (size_t i = 0; i < 6; ++i)
    CHECK((scene.instances[i].transform.offset - Vec3f(float(i), 1, 0)).norm() < 1e-6);
  CHECK(scene.instances[5].mesh->indices.size() == 12);
  CHECK(scene.lines.empty());
  CHECK(scene.points.empty());
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
  const auto wrong = parse_overlays("contcts");
  REQUIRE_FALSE(wrong.ok());
  CHECK(wrong.error().message.find("contacts") != std::string::npos);
}
