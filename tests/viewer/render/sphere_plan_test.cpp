// Particles: which are hidden, and how they are sorted into runs. Reference: brute force over
// pixels and over all pairs of discs, in double.
#include "viewer/render/sphere_plan.hpp"

#include "engine/core/random.hpp"
#include "viewer/render/disc_occlusion.hpp"
#include "viewer/render/frame_setup.hpp"

#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

std::vector<ProjectedDisc> random_discs(Random& random, int count, double radius) {
  std::vector<ProjectedDisc> discs;
  for (int i = 0; i < count; ++i) {
    ProjectedDisc d;
    d.x = float(random.uniform(-5, 85));
    d.y = float(random.uniform(-5, 65));
    const double r = random.uniform(0.2, radius), z = random.uniform(1, 9);
    d.cover_radius = float(0.9 * r);
    d.outline_radius = float(r);
    d.cover_depth = float(z);
    d.nearest_depth = float(z - 0.1);
    discs.push_back(d);
  }
  return discs;
}

bool holds(const ProjectedDisc& d, double radius, int x, int y) {
  return std::hypot(x + 0.5 - double(d.x), y + 0.5 - double(d.y)) < radius;
}

/// Some pixel of the disc has nothing before it. `slack` [px] makes discs larger, covers smaller.
bool seen_by_pixels(const std::vector<ProjectedDisc>& discs, size_t of, double slack) {
  const ProjectedDisc& d = discs[of];
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) {
      if (!holds(d, double(d.outline_radius) + slack, x, y)) continue;
      const bool covered = std::any_of(discs.begin(), discs.end(), [&](const ProjectedDisc& o) {
        return o.cover_depth < d.nearest_depth && holds(o, double(o.cover_radius) - slack, x, y);
      });
      if (!covered) return true;
    }
  return false;
}

RenderScene heap(int side) {
  RenderScene scene;
  for (int i = 0; i < side * side * side; ++i)
    scene.spheres.push_back(
        {Vec3f(float(i % side), float(i / side % side), float(i / side / side)) * 0.2f, 0.1f,
         Vec4f(1, 1, 1, 1)});
  return scene;
}

DrawPlan plan_of(const RenderScene& scene) {
  DrawPlan plan;
  make_draw_plan(scene, make_frame_setup(scene, 640, 360).view, plan);
  return plan;
}

}  // namespace

TEST_CASE("hidden discs are those that a search over all pixels finds hidden") {
  Random random(11);
  DiscOcclusion occlusion;
  std::vector<uint8_t> hidden;
  int all = 0, covered = 0, unsure = 0;
  for (int round = 0; round < 12; ++round) {
    const auto discs = random_discs(random, 120, 4 + round);
    occlusion.find_hidden(discs, 80, 60, hidden);
    REQUIRE(hidden.size() == discs.size());
    for (size_t i = 0; i < discs.size(); ++i) {
      // Centres within rounding of an edge may fall on either side.
      const bool surely = seen_by_pixels(discs, i, -1e-3), maybe = seen_by_pixels(discs, i, 1e-3);
      if (surely != maybe)
        ++unsure;
      else
        CHECK(bool(hidden[i]) == !surely);
      ++all;
      covered += hidden[i];
    }
  }
  CHECK(covered > all / 5);
  CHECK(covered < all * 4 / 5);
  CHECK(unsure < all / 20);
}

TEST_CASE("hostile discs: none, outside, huge, of no size, infinite") {
  DiscOcclusion occlusion;
  std::vector<uint8_t> hidden;
  occlusion.find_hidden({}, 10, 10, hidden);
  CHECK(hidden.empty());
  const float huge = 1e30f, infinite = std::numeric_limits<float>::infinity();
  occlusion.find_hidden({{5, 5, huge, 2, huge, 1},
                         {500, 5, 3, 2, 3, 1},
                         {5, 5, 0, 9, 0, 9},
                         {5, 5, 1, 9, 1, 8},
                         {infinite, 5, 1, 9, 1, 8}},
                        10, 10, hidden);
  CHECK(hidden == std::vector<uint8_t>{0, 1, 1, 1, 1});
}

TEST_CASE("a heap of particles is drawn by its skin, and every run holds what it should") {
  RenderScene scene = heap(16);
  scene.camera.eye = Vec3(6, 5, 9);
  scene.camera.target = Vec3(1.5, 1.5, 1.5);
  const DrawPlan plan = plan_of(scene);
  CHECK(plan.visible + plan.culled == 4096);
  CHECK(plan.visible == plan.opaque_spheres.count);
  CHECK(plan.visible < 4096 / 2);
  // The three faces that the eye sees are all there.
  std::vector<std::array<float, 3>> drawn;
  for (uint32_t i = 0; i < plan.opaque_spheres.count; ++i)
    drawn.push_back(plan.sphere_vertices[3 * (plan.opaque_spheres.first + i)].centre);
  std::sort(drawn.begin(), drawn.end());
  for (const SphereInstance& s : scene.spheres) {
    if (std::max({s.centre.x(), s.centre.y(), s.centre.z()}) < 2.99f) continue;
    const std::array<float, 3> x = {s.centre.x(), s.centre.y(), s.centre.z()};
    CHECK(std::binary_search(drawn.begin(), drawn.end(), x));
  }
  const SphereRun& low = plan.low_spheres;
  CHECK(low.first >= plan.sphere_casters.first);
  CHECK(low.first + low.count <= plan.sphere_casters.first + plan.sphere_casters.count);
  for (uint32_t i = 0; i < low.count; ++i)
    CHECK(plan.sphere_vertices[3 * (low.first + i)].centre[1] < 1);
}

TEST_CASE("ghost particles are drawn far to near and hide nothing, nonsense is left out") {
  RenderScene scene;
  scene.camera.eye = Vec3(0, 1, 12);
  scene.camera.target = Vec3(0, 1, 0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  scene.spheres = {{Vec3f(0, 1, 3), 0.5f, Vec4f(1, 1, 1, 0.5f)},
                   {Vec3f(0, 1, 0), 0.5f, Vec4f(1, 1, 1, 0.5f)},
                   {Vec3f(0, 1, -3), 0.1f, Vec4f(1, 1, 1, 1)},
                   {Vec3f(0, 1, 12.1f), 0.5f, Vec4f(1, 1, 1, 1)},  // around the eye
                   {Vec3f(nan, 1, 0), 0.5f, Vec4f(1, 1, 1, 1)},
                   {Vec3f(1, 1, 0), 0, Vec4f(1, 1, 1, 1)},
                   {Vec3f(1, 1, 0), nan, Vec4f(1, 1, 1, 1)},
                   {Vec3f(1, 1, 0), infinite, Vec4f(1, 1, 1, 1)},
                   {Vec3f(0, 1e4f, -5e4f), 1e3f, Vec4f(1, 1, 1, 1)}};
  const DrawPlan plan = plan_of(scene);
  CHECK(plan.visible == 3);
  CHECK(content_bounds(scene).max.allFinite());
  CHECK(plan.opaque_spheres.count == 1);
  REQUIRE(plan.blended_spheres.count == 2);
  const auto z = [&](uint32_t i) {
    return plan.sphere_vertices[3 * (plan.blended_spheres.first + i)].centre[2];
  };
  CHECK(z(0) == 0);
  CHECK(z(1) == 3);
}
