// From a frame to flat data. Reference: counts and places worked out by hand from frames built in
// the test; no GL and no world is involved.
#include "engine/math/rotation.hpp"
#include "tests/support/shape_reference.hpp"
#include "tests/viewer/extract/frame_maker.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

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
  then->x = {{5, 5, 5}, {0, 0, 0}};  // the first dies in between
  then->radius = {0.1, 0.1};
  then->colour = {Vec3f(0, 1, 0), Vec3f(1, 0, 0)};
  then->ids = {6, 7};
  m.frame.particles = {then};
  const Frame from = m.make();
  m.bodies[0].pose.x = {1, 0, 0};
  m.bodies[1].pose.x = {8, 5, 0};
  m.bodies[1].jumped = true;
  auto now = std::make_shared<ParticleFrame>(*then);
  now->x = {{0, 4, 0}, {3, 3, 3}};  // the second is born
  now->radius = {0.1, 0.1};
  now->colour = {Vec3f(1, 0, 0), Vec3f(0, 0, 1)};
  now->ids = {7, 8};
  now->glow = 2;
  m.frame.particles = {now};
  const Frame to = m.make();
  const RenderScene scene = extracted(from, to, 0.25);
  CHECK(scene.instances[0].transform.offset.x() == doctest::Approx(0.25));
  CHECK(scene.instances[1].transform.offset.x() == doctest::Approx(8));
  REQUIRE(scene.spheres.size() == 2);
  CHECK(scene.spheres[0].centre.y() == doctest::Approx(1));
  CHECK(scene.spheres[0].colour.x() == 1);
  CHECK(scene.spheres[0].colour.w() == 3);  // opaque, and it glows
  CHECK(scene.spheres[1].centre.y() == doctest::Approx(3));
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

TEST_CASE("particles look as their system says: coloured with a legend, as a liquid, as smoke") {
  FrameMaker m;
  auto coloured = std::make_shared<ParticleFrame>();
  coloured->name = "sand";
  coloured->x = {{0, 0, 0}, {1, 0, 0}};
  coloured->radius = {0.1, 0.1};
  coloured->colour = {Vec3f(1, 0, 0), Vec3f(1, 0, 0)};
  coloured->ids = {1, 2};
  coloured->look.colour_by = ParticleQuantity::speed;
  coloured->value = {0, 2.6f};
  coloured->range = {0, 2.6};
  auto liquid = std::make_shared<ParticleFrame>(*coloured);
  liquid->look = {};
  liquid->look.style = ParticleStyle::surface;
  liquid->look.clarity = 0.7;
  liquid->v = {Vec3f::Zero(), Vec3f::Zero()};
  liquid->share = {1, 1};
  auto smoke = std::make_shared<ParticleFrame>(*coloured);
  smoke->look = {};
  smoke->look.style = ParticleStyle::smoke;
  smoke->opacity = {0.3f, 0};
  smoke->age = {0, 1};
  auto none_yet = std::make_shared<ParticleFrame>();  // of one colour, so without a legend
  none_yet->name = "rain";
  m.frame.particles = {coloured, liquid, smoke, none_yet};
  const Frame frame = m.make();
  const RenderScene scene = extracted(frame, frame, 1);
  REQUIRE(scene.spheres.size() == 2);
  CHECK(scene.spheres[0].colour.z() > scene.spheres[0].colour.y());      // violet
  CHECK(scene.spheres[1].colour.y() > 4 * scene.spheres[1].colour.z());  // yellow
  REQUIRE(scene.legends.size() == 1);
  CHECK(scene.legends[0].title == "sand: speed");
  CHECK(scene.legends[0].unit == "m/s");
  CHECK(scene.legends[0].high == doctest::Approx(3));  // rounded: no range was given
  REQUIRE(scene.fluids.size() == 1);
  CHECK(scene.fluids[0].particles.size() == 2);
  CHECK(scene.fluids[0].clarity == 0.7f);
  CHECK(scene.fluids[0].colour.x() == 1);
  REQUIRE(scene.smoke.size() == 2);
  CHECK(scene.smoke[0].opacity == 0.3f);
  CHECK(scene.smoke[0].radius > 0.1f);
}
