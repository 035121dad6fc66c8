// Culling, levels of detail and sorting. Reference: brute force over the same instances.
#include "engine/core/random.hpp"
#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/frame_setup.hpp"

#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

uint32_t total(const std::vector<Batch>& batches) {
  uint32_t n = 0;
  for (const Batch& b : batches) n += b.count;
  return n;
}

DrawPlan plan_of(const RenderScene& scene) {
  DrawPlan plan;
  make_draw_plan(scene, make_frame_setup(scene, 640, 360).view, plan);
  return plan;
}

}  // namespace

TEST_CASE("what cannot be seen is left out, what can be is kept") {
  Random random(2);
  RenderScene scene;
  for (int i = 0; i < 800; ++i)
    scene.instances.push_back(
        box_instance({Vec3{random.uniform(-20, 20), random.uniform(0, 9), random.uniform(-20, 20)},
                      Quat::Identity()},
                     Vec3::Constant(0.17), Paint()));
  const FrameSetup setup = make_frame_setup(scene, 640, 360);
  uint32_t inside = 0;
  for (const MeshInstance& i : scene.instances) {
    const Vec3 p = project(setup.camera, i.transform.offset.cast<double>(), 640, 360);
    inside += p.z() > 0 && p.x() >= 0 && p.x() < 640 && p.y() >= 0 && p.y() < 360;
  }
  const DrawPlan plan = plan_of(scene);
  CHECK(plan.visible >= inside);
  CHECK(plan.visible < inside * 5 / 4 + 20);
  CHECK(plan.visible + plan.culled == 800);
  CHECK(total(plan.opaque) == plan.visible);
  CHECK(inside > 100);
  CHECK(inside < 700);
}

TEST_CASE("layers: opaque by mesh, ghosts far to near, selected outlined, casters") {
  RenderScene scene;
  Paint ghost;
  ghost.opacity = 0.5f;
  const auto at = [](double z) { return Pose{Vec3(0, 1, z), Quat::Identity()}; };
  scene.camera.eye = Vec3(0, 2, 12);
  scene.instances = {
      box_instance(at(0), Vec3::Ones(), {}), sphere_instance(at(1), 1, {}),
      box_instance(at(2), Vec3::Ones(), {}), sphere_instance(at(-3), 1, ghost),
      sphere_instance(at(3), 1, ghost),      box_instance(at(0.5), Vec3::Ones(), ghost)};
  scene.instances[0].selected = true;
  const DrawPlan plan = plan_of(scene);
  CHECK(plan.opaque.size() == 2);
  CHECK(total(plan.opaque) == 3);
  CHECK(total(plan.outlined) == 1);
  CHECK(total(plan.casters) + plan.ball_casters.count == 3);
  REQUIRE(total(plan.blended) == 3);
  std::vector<float> z;
  for (const Batch& b : plan.blended)
    for (uint32_t i = 0; i < b.count; ++i) z.push_back(plan.instances[b.first + i].rows[2][3]);
  CHECK(z == std::vector<float>{-3, 0.5f, 3});
}

TEST_CASE("balls are cards, those behind others are left out and still cast shadows") {
  RenderScene scene;
  constexpr int side = 8;
  for (int i = 0; i < side * side * side; ++i)
    scene.instances.push_back(sphere_instance(
        {Vec3(i % side, 1 + i / side % side, i / side / side) * 0.5, Quat::Identity()}, 0.3, {}));
  scene.camera.eye = Vec3(8, 6, 9);
  scene.camera.target = Vec3(2, 2, 2);
  const DrawPlan plan = plan_of(scene);
  REQUIRE(plan.opaque.size() == 1);
  CHECK(plan.opaque[0].mesh->ball);
  CHECK(plan.visible == total(plan.opaque));
  CHECK(plan.visible + plan.culled == scene.instances.size());
  CHECK(total(plan.casters) == 0);
  CHECK(plan.ball_casters.count == scene.instances.size());
  // Three faces of the cube are seen, the inside is not.
  CHECK(plan.visible >= 3 * side * side - 3 * side);
  CHECK(plan.visible < scene.instances.size() / 2);
  // The reference for hidden: particles at the same places.
  RenderScene particles = scene;
  particles.instances.clear();
  for (const MeshInstance& i : scene.instances)
    particles.spheres.push_back({i.transform.offset, 0.3f, Vec4f::Ones()});
  CHECK(plan.visible == plan_of(particles).visible);
}

TEST_CASE("a ball casts the shadow of a particle of its place and size, a squashed one its own") {
  RenderScene scene;
  const Pose pose{Vec3(0, 1, 0.5), Quat::Identity()};
  scene.spheres.push_back({Vec3f(1, 1, 1), 0.2f, Vec4f::Ones()});
  scene.instances = {sphere_instance(pose, 0.3, {}),
                     mesh_instance(sphere_mesh(), pose, Vec3(0.3, 0.4, 0.3), {})};
  const DrawPlan plan = plan_of(scene);
  CHECK(total(plan.casters) == 1);
  REQUIRE(plan.ball_casters.count == 1);
  REQUIRE(plan.sphere_vertices.size() == 6);
  for (uint32_t k = 0; k < 3; ++k) {
    const GpuSphere& ball = plan.sphere_vertices[3 * plan.ball_casters.first + k];
    CHECK(ball.centre == std::array<float, 3>{0, 1, 0.5f});
    CHECK(ball.radius == doctest::Approx(0.3));
  }
}

TEST_CASE("opaque bodies come in batches of plain ones and of those with a pattern") {
  RenderScene scene;
  for (int i = 0; i < 9; ++i) {
    Paint paint;
    paint.pattern = i % 3 == 0 ? Pattern::quarters : Pattern::plain;
    paint.opacity = i < 7 ? 1.f : 0.5f;
    scene.instances.push_back(
        box_instance({Vec3(i - 4, 1, 0), Quat::Identity()}, Vec3(0.3, 0.3, 0.3), paint));
  }
  const DrawPlan plan = plan_of(scene);
  std::array<uint32_t, 2> counts{};
  for (const Batch& b : plan.opaque) {
    counts[b.patterned] += b.count;
    for (uint32_t i = b.first; i < b.first + b.count; ++i)
      CHECK((plan.instances[i].pattern[0] > 0) == b.patterned);
  }
  CHECK(counts == std::array<uint32_t, 2>{4, 3});
  for (const auto* list : {&plan.blended, &plan.casters, &plan.low})
    for (const Batch& b : *list) CHECK_FALSE(b.patterned);
}

TEST_CASE("squashed, see-through and near balls, and outlines, are meshes") {
  RenderScene scene;
  const Pose pose{Vec3(0, 1, 0), Quat::Identity()};
  scene.camera.eye = Vec3(0, 2, 8);
  const auto is_card = [&](const MeshInstance& ball) {
    scene.instances = {ball};
    const DrawPlan plan = plan_of(scene);
    return !plan.opaque.empty() && plan.opaque[0].mesh->ball;
  };
  CHECK(is_card(sphere_instance(pose, 1, {})));
  CHECK_FALSE(is_card(mesh_instance(sphere_mesh(), pose, Vec3(1, 1.1, 1), {})));
  Paint ghost;
  ghost.opacity = 0.5f;
  CHECK_FALSE(is_card(sphere_instance(pose, 1, ghost)));
  scene.camera.eye = Vec3(0, 1.5, 0);
  CHECK_FALSE(is_card(sphere_instance(pose, 1, {})));
  scene.camera.eye = Vec3(0, 2, 8);
  MeshInstance selected = sphere_instance(pose, 1, {});
  selected.selected = true;
  CHECK(is_card(selected));
  REQUIRE(plan_of(scene).outlined.size() == 1);
  CHECK_FALSE(plan_of(scene).outlined[0].mesh->ball);
}

TEST_CASE("small pictures of a shape use fewer triangles, and the true size stays") {
  RenderScene scene;
  scene.instances = {cylinder_instance({Vec3(0, 1, 0), Quat::Identity()}, 0.5, 1, {})};
  scene.camera.eye = Vec3(0, 2, 5);
  const DrawPlan close = plan_of(scene);
  scene.camera.eye = Vec3(0, 2, 300);
  const DrawPlan far = plan_of(scene);
  REQUIRE(close.opaque.size() == 1);
  REQUIRE(far.opaque.size() == 1);
  CHECK(far.opaque[0].mesh->indices.size() < close.opaque[0].mesh->indices.size() / 3);
  const GpuInstance& g = far.instances[far.opaque[0].first];
  CHECK(g.look[3] == 0);
  CHECK(g.rows[0][0] == doctest::Approx(0.5));
  CHECK(g.rows[1][1] == doctest::Approx(1));
}

TEST_CASE("rounds too thin to see are left out, and the box keeps its size") {
  RenderScene scene;
  scene.instances = {box_instance({Vec3(0, 1, 0), Quat::Identity()}, Vec3(2, 0.1, 2), {})};
  scene.camera.target = Vec3(0, 1, 0);
  scene.camera.eye = Vec3(0, 2, 8);
  const DrawPlan close = plan_of(scene);
  scene.camera.eye = Vec3(0, 2, 30);
  const DrawPlan far = plan_of(scene);
  CHECK(close.opaque.at(0).mesh->indices.size() > far.opaque.at(0).mesh->indices.size());
  const GpuInstance& g = far.instances[far.opaque[0].first];
  CHECK(g.look[3] == 0);
  CHECK(g.rows[0][0] == doctest::Approx(2));
  CHECK(g.rows[1][1] == doctest::Approx(0.1));
}

TEST_CASE("a colour of the haze replaces the horizon in haze and sky, not in the light") {
  RenderScene scene;
  const GpuFrame plain = make_frame_setup(scene, 64, 36).uniforms;
  scene.haze_colour = Vec3f(1, 0, 0);
  const GpuFrame red = make_frame_setup(scene, 64, 36).uniforms;
  CHECK(red.haze == std::array<float, 4>{1, 0, 0, 0});
  CHECK(red.sky_horizon == std::array<float, 4>{1, 0, 0, 0});
  CHECK(red.horizon == plain.horizon);
  CHECK(plain.haze != red.haze);
}

TEST_CASE("what has flown away or is not finite changes neither depth nor shadows of the rest") {
  RenderScene scene;
  const auto at = [](const Vec3& x) { return Pose{x, Quat::Identity()}; };
  scene.instances.push_back(box_instance(at(Vec3(0, 1, 0)), Vec3::Ones(), {}));
  scene.instances.push_back(box_instance(at(Vec3(3, 1, 0)), Vec3::Ones(), {}));
  const FrameSetup alone = make_frame_setup(scene, 640, 360);
  const DrawPlan plan = plan_of(scene);
  for (const double far : {1e6, 1e12, 1e30, 1e300}) {
    RenderScene more = scene;
    more.instances.push_back(box_instance(at(Vec3(far, -far, 0.5 * far)), Vec3::Ones(), {}));
    more.spheres.push_back({Vec3f(0, float(far), 0), 0.1f, Vec4f::Ones()});
    more.spheres.push_back({Vec3f(std::numeric_limits<float>::quiet_NaN(), 0, 0), 0.1f, {}});
    const FrameSetup setup = make_frame_setup(more, 640, 360);
    CHECK(setup.camera.near == alone.camera.near);
    CHECK(setup.camera.far == alone.camera.far);
    for (int j = 0; j < 4; ++j)
      CHECK(setup.view.shadow_from_world.col(j) == alone.view.shadow_from_world.col(j));
    CHECK(setup.uniforms.contact == alone.uniforms.contact);
    CHECK(plan_of(more).visible == plan.visible);
  }
  // A floor as large as a planet: what lies within reach is seen and shaded as sharply as before.
  RenderScene planet = scene;
  planet.instances.push_back(box_instance(at(Vec3(0, -1e9, 0)), Vec3::Constant(1e9), {}));
  const FrameSetup on_planet = make_frame_setup(planet, 640, 360);
  CHECK(on_planet.camera.far < 3000 * (planet.camera.eye - planet.camera.target).norm());
  CHECK(on_planet.camera.near > 1e-3);
  for (int j = 0; j < 4; ++j) CHECK(on_planet.view.shadow_from_world.col(j).allFinite());
}
