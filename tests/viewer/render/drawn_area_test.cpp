// What of a picture bodies cover, and how far down it the sky is seen. References: every vertex of
// every mesh, projected; a ray through each of many pixels.
#include "viewer/render/drawn_area.hpp"

#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "viewer/render/background.hpp"
#include "viewer/render/builtin_meshes.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr int picture_width = 320, picture_height = 180;

Vec3 draw_vector(Random& r, double a, double b) {
  const double x = r.uniform(a, b), y = r.uniform(a, b);
  return {x, y, r.uniform(a, b)};
}

RenderScene random_bodies(Random& r, int count) {
  RenderScene scene;
  scene.camera.eye = draw_vector(r, -6, 6);
  scene.camera.target = draw_vector(r, -2, 2);
  for (int i = 0; i < count; ++i) {
    const Pose pose{
        draw_vector(r, -3, 3),
        axis_angle(Vec3(r.uniform(-1, 1), 1, r.uniform(-1, 1)).normalized(), r.uniform(-3, 3))};
    const double s = r.uniform(0.05, 1);
    switch (i % 4) {
      case 0:
        scene.instances.push_back(box_instance(pose, draw_vector(r, 0.05, 1), Paint()));
        break;
      case 1:
        scene.instances.push_back(capsule_instance(pose, s, 2 * s, Paint()));
        break;
      case 2:
        scene.instances.push_back(cylinder_instance(pose, s, 0.3 * s, Paint()));
        break;
      default:
        scene.instances.push_back(ellipsoid_instance(pose, draw_vector(r, 0.05, 1), Paint()));
    }
  }
  return scene;
}

/// Least rectangle around the vertices in the picture [px], from its top left.
struct Seen {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  bool near = false;    ///< some are nearer than anything is drawn
  bool beside = false;  ///< some are not in the picture
};
Seen project_vertices(const RenderScene& scene, const ViewSetup& view) {
  Seen seen;
  for (const MeshInstance& i : scene.instances)
    for (size_t v = 0; v < i.mesh->positions.size(); ++v) {
      const Mat3f& l = i.transform.linear;
      const Vec3f axes(l.col(0).norm(), l.col(1).norm(), l.col(2).norm());
      const Vec3f n = i.mesh->normals[v];
      Vec3f along = Vec3f::Zero();  // inflated cores keep their normals (surface.vert)
      for (int k = 0; k < 3; ++k)
        if (axes[k] > 0) along += l.col(k) * (n[k] / axes[k]);
      const Vec3f x = l * i.mesh->positions[v] + i.transform.offset + along * i.inflate;
      const Vec4 c = view.clip_from_world * Vec4(double(x.x()), double(x.y()), double(x.z()), 1);
      if (c.z() < -c.w()) {
        seen.near = true;
        continue;
      }
      const double px = 0.5 * (c.x() / c.w() + 1) * view.width;
      const double py = 0.5 * (1 - c.y() / c.w()) * view.height;
      if (px < 0 || px > view.width || py < 0 || py > view.height) {
        seen.beside = true;
        continue;
      }
      seen.left = std::min(seen.left, px);
      seen.right = std::max(seen.right, px);
      seen.top = std::min(seen.top, py);
      seen.bottom = std::max(seen.bottom, py);
    }
  return seen;
}

}  // namespace

TEST_CASE("the area of bodies holds all their vertices, and little more around a box") {
  Random random(28);
  int small = 0, tight = 0;
  for (int round = 0; round < 300; ++round) {
    const RenderScene scene = random_bodies(random, round % 3 == 0 ? 1 : 1 + round % 7);
    const FrameSetup setup = make_frame_setup(scene, picture_width, picture_height);
    const auto area = drawn_area(scene, setup.view);
    const Seen seen = project_vertices(scene, setup.view);
    if (seen.near || seen.left > seen.right) continue;
    REQUIRE(area.has_value());
    CHECK(area->x <= seen.left);
    CHECK(area->y <= seen.top);
    CHECK(area->x + area->width >= seen.right);
    CHECK(area->y + area->height >= seen.bottom);
    small += area->width < 200 && area->height < 120;
    if (scene.instances.size() == 1 && !seen.beside) {  // a box: its corners are chamfered, no more
      CHECK(area->width <= seen.right - seen.left + 10);
      CHECK(area->height <= seen.bottom - seen.top + 10);
      ++tight;
    }
  }
  CHECK(small > 30);
  CHECK(tight > 20);
}

TEST_CASE("without bodies no area is drawn, around the eye all of it") {
  RenderScene scene;
  const ViewSetup empty = make_frame_setup(scene, picture_width, picture_height).view;
  CHECK_FALSE(drawn_area(scene, empty).has_value());
  scene.instances.push_back(
      box_instance({scene.camera.eye, Quat::Identity()}, Vec3::Constant(0.5), Paint()));
  const FrameSetup setup = make_frame_setup(scene, picture_width, picture_height);
  const auto area = drawn_area(scene, setup.view);
  REQUIRE(area.has_value());
  CHECK(area->width == picture_width);
  CHECK(area->height == picture_height);
}

TEST_CASE("below the rows of the sky every ray meets the ground") {
  Random random(29);
  int part = 0, level = 0;
  for (int round = 0; round < 200; ++round) {
    RenderScene scene;
    scene.camera.eye = draw_vector(random, -5, 5) + Vec3(0, 6, 0);
    scene.camera.target = draw_vector(random, -5, 5);
    scene.camera.up = round % 2 ? Vec3::UnitY() : draw_vector(random, -1, 1);
    scene.camera.fov_deg = random.uniform(20, 110);
    const FrameSetup setup = make_frame_setup(scene, picture_width, picture_height);
    const int rows = rows_with_sky(scene, setup);
    // A ray sees the ground where that is nearer than the far plane.
    const auto sees_sky = [&](int column, int row) {
      const double x = (column + 0.5) / picture_width * 2 - 1,
                   y = 1 - (row + 0.5) / picture_height * 2;
      const GpuFrame& u = setup.uniforms;
      const auto ray = [&](int k) {
        const auto i = size_t(k);
        return double(u.view_forward[i]) + x * double(u.view_right[i]) + y * double(u.view_up[i]);
      };
      const double depth = (double(scene.ground.height) - setup.view.eye.y()) / ray(1);
      return !(ray(1) < 0 && depth < setup.camera.far);
    };
    int last = -1;
    for (int row = 0; row < picture_height; ++row)
      for (int column = 0; column < picture_width; column += 3)
        if (sees_sky(column, row)) last = row;
    CHECK(rows > last);
    part += rows > 0 && rows < picture_height;
    if (round % 2) {  // no more than two rows, unless it looks straight up or down
      CHECK(rows <= last + 4);
      ++level;
    }
  }
  CHECK(part > 30);
  CHECK(level == 100);
}
