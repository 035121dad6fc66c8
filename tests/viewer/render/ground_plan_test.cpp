// The ground in squares. Reference: rays from points of the ground towards the sun, against every
// box.
#include "viewer/render/ground_plan.hpp"

#include "engine/core/random.hpp"
#include "viewer/render/builtin_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

Vec3 random_vector(Random& r, double a, double b) {
  const double x = r.uniform(a, b), y = r.uniform(a, b);
  return {x, y, r.uniform(a, b)};
}

RenderScene boxes(Random& r, int count) {
  RenderScene scene;
  scene.ground.height = r.uniform(-1, 1);
  scene.sun.to_sun = Vec3(r.uniform(-1, 1), r.uniform(0.15, 1), r.uniform(-1, 1));
  scene.camera.eye = Vec3(r.uniform(-5, 5), r.uniform(2, 6), 12);
  scene.camera.target = Vec3::Zero();
  for (int i = 0; i < count; ++i)
    scene.instances.push_back(box_instance(
        {Vec3(r.uniform(-4, 4), scene.ground.height + r.uniform(-0.5, 4), r.uniform(-4, 4)),
         Quat::Identity()},
        random_vector(r, 0.2, 1.5), Paint()));
  return scene;
}

/// Whether a ray meets a box: by slabs.
bool meets(const Aabb& box, const Vec3& from, const Vec3& along) {
  double begin = 0, end = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const double a = (box.min[k] - from[k]) / along[k], b = (box.max[k] - from[k]) / along[k];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end;
}

double twice_area(const GroundPlan& plan, size_t triangle) {
  std::array<Vec2, 3> p;
  for (size_t k = 0; k < 3; ++k) {
    const auto& c = plan.corners[plan.triangles[3 * triangle + k]];
    p[k] = Vec2(double(c[0]), double(c[1]));
  }
  const Vec2 a = p[1] - p[0], b = p[2] - p[0];
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether triangles of the first kind hold a point of the plane: a square is two of them, the
/// first corner of the first and the last of the second its ends.
bool is_shaded(const GroundPlan& plan, double x, double z) {
  for (size_t i = 0; i < plan.shaded; i += 6) {
    const auto &a = plan.corners[plan.triangles[i]], &b = plan.corners[plan.triangles[i + 5]];
    if (x >= double(a[0]) && x <= double(b[0]) && z >= double(a[1]) && z <= double(b[1]))
      return true;
  }
  return false;
}

}  // namespace

TEST_CASE("ground that a body keeps the sun from, or stands on, looks into the maps") {
  Random r(12);
  int in_shadow = 0, bare = 0;
  for (int n = 0; n < 60; ++n) {
    const RenderScene scene = boxes(r, 1 + n % 5);
    const FrameSetup setup = make_frame_setup(scene, 640, 360);
    GroundPlan plan;
    plan_ground(scene, setup, plan);
    const Vec3 to_sun = scene.sun.to_sun.normalized();
    for (int k = 0; k < 300; ++k) {
      const Vec3 x(r.uniform(-12, 12), scene.ground.height, r.uniform(-12, 12));
      bool shaded = false;
      for (const MeshInstance& i : scene.instances) {
        Aabb box = bounds_of(i);
        shaded |= meets(box, x, to_sun);
        box.max.y() = std::max(box.max.y(), scene.ground.height);
        shaded |=
            box.min.y() < setup.view.contact_below && box.contains(Vec3(x.x(), box.max.y(), x.z()));
      }
      in_shadow += shaded;
      if (shaded) CHECK(is_shaded(plan, x.x(), x.z()));
      if (!shaded) bare += !is_shaded(plan, x.x(), x.z());
    }
  }
  CHECK(in_shadow > 500);
  CHECK(bare > 5000);
}

TEST_CASE("the squares cover the ground once, out to the haze, and all face up") {
  Random r(13);
  for (int n = 0; n < 30; ++n) {
    const RenderScene scene = boxes(r, n % 4);
    const FrameSetup setup = make_frame_setup(scene, 640, 360);
    GroundPlan plan;
    plan_ground(scene, setup, plan);
    REQUIRE(plan.triangles.size() % 6 == 0);
    if (n % 4 == 0) CHECK(plan.triangles.size() == 6);
    double sum = 0;
    for (size_t t = 0; 3 * t < plan.triangles.size(); ++t) {
      CHECK(twice_area(plan, t) >= 0);
      sum += 0.5 * twice_area(plan, t);
    }
    const double side = 2.2 * setup.camera.far;
    CHECK(sum == doctest::Approx(side * side).epsilon(1e-5));
    CHECK(plan.corners.size() < 2000);
  }
}

TEST_CASE("lines of the squares stay in place while bodies move a little") {
  Random r(14);
  RenderScene scene = boxes(r, 3);
  std::set<float> before;
  int kept = 0, all = 0;
  for (int n = 0; n < 20; ++n) {
    GroundPlan plan;
    plan_ground(scene, make_frame_setup(scene, 640, 360), plan);
    std::set<float> lines;
    for (const auto& c : plan.corners) lines.insert(c[0]);
    for (const float x : lines) kept += int(before.count(x)), ++all;
    before = lines;
    for (MeshInstance& i : scene.instances) i.transform.offset.x() += 0.013f;
  }
  CHECK(kept > 0.8 * all);
}
