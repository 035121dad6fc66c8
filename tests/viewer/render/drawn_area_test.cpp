// Parts of a picture that bodies cover, and how far down it the sky is seen. References: every
// vertex of every mesh, projected; a ray through each of many pixels.
#include "viewer/render/drawn_area.hpp"

#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "viewer/render/background.hpp"
#include "viewer/render/builtin_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

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

/// The vertices as they are drawn: inflated cores keep their normals (surface.vert).
std::vector<Vec3> vertices_of(const MeshInstance& i) {
  std::vector<Vec3> out;
  const Mat3f& l = i.transform.linear;
  for (size_t v = 0; v < i.mesh->positions.size(); ++v) {
    Vec3f along = Vec3f::Zero();
    for (int k = 0; k < 3; ++k)
      if (const float axis = l.col(k).norm(); axis > 0)
        along += l.col(k) * (i.mesh->normals[v][k] / axis);
    out.push_back(
        (l * i.mesh->positions[v] + i.transform.offset + along * i.inflate).cast<double>());
  }
  return out;
}

/// Where a point is in the picture [px], from its top left; none where it is not.
std::optional<Vec2> place_of(const Vec3& x, const ViewSetup& view) {
  const Vec4 c = view.clip_from_world * Vec4(x.x(), x.y(), x.z(), 1);
  if (c.z() < -c.w()) return {};
  const Vec2 at(0.5 * (c.x() / c.w() + 1) * view.width, 0.5 * (1 - c.y() / c.w()) * view.height);
  const bool inside = at.x() >= 0 && at.x() < view.width && at.y() >= 0 && at.y() < view.height;
  return inside ? std::optional(at) : std::nullopt;
}

/// How many of the parts hold a place.
int parts_at(const std::vector<ScissorRect>& parts, const Vec2& at) {
  return int(std::count_if(parts.begin(), parts.end(), [&](const ScissorRect& p) {
    return at.x() >= p.x && at.x() < p.x + p.width && at.y() >= p.y && at.y() < p.y + p.height;
  }));
}

int pixels_of(const std::vector<ScissorRect>& parts) {
  int sum = 0;
  for (const ScissorRect& p : parts) sum += p.width * p.height;
  return sum;
}

}  // namespace

TEST_CASE("each vertex of a body is in one of the parts that bodies are drawn in") {
  Random random(28);
  int vertices = 0, several = 0, small = 0;
  for (int round = 0; round < 300; ++round) {
    const RenderScene scene = random_bodies(random, round % 3 == 0 ? 1 : 1 + round % 7);
    const ViewSetup view = make_frame_setup(scene, picture_width, picture_height).view;
    const auto parts = drawn_parts(scene, view);
    for (const MeshInstance& i : scene.instances)
      for (const Vec3& x : vertices_of(i))
        if (const auto at = place_of(x, view)) {
          CHECK(parts_at(parts, *at) == 1);
          ++vertices;
        }
    several += parts.size() > 1;
    small += pixels_of(parts) < picture_width * picture_height / 3;
  }
  CHECK(vertices > 10000);
  CHECK(several > 50);
  CHECK(small > 30);
}

TEST_CASE("what the ground hides of a body is in one of the parts that are drawn below it") {
  Random random(30);
  int below = 0, spared = 0;
  for (int round = 0; round < 300; ++round) {
    RenderScene scene = random_bodies(random, 1 + round % 5);
    scene.camera.eye.y() = std::abs(scene.camera.eye.y()) + 1;
    scene.ground.height = random.uniform(-3, 0);
    const ViewSetup view = make_frame_setup(scene, picture_width, picture_height).view;
    const auto parts = sunken_parts(scene, view);
    for (const MeshInstance& i : scene.instances)
      for (const Vec3& x : vertices_of(i)) {
        const double pixel = (x - view.eye).dot(view.forward) / view.pixels_per_radian;
        const auto at = place_of(x, view);
        if (!at || x.y() > double(scene.ground.height) - 0.01 * pixel) continue;
        CHECK(parts_at(parts, *at) == 1);
        ++below;
      }
    spared += parts.empty() && !drawn_parts(scene, view).empty();
  }
  CHECK(below > 1000);
  CHECK(spared > 20);
}

TEST_CASE(
    "a ball just over the ground is not below it, one that is selected has an outline there") {
  RenderScene scene;
  scene.camera.eye = Vec3(0, 2, 8);
  scene.ground.height = 0;
  const Pose turned{Vec3(0, 0.51, 0), axis_angle(Vec3(1, 2, 3).normalized(), 0.7)};
  scene.instances.push_back(sphere_instance(turned, 0.5, Paint()));
  const ViewSetup view = make_frame_setup(scene, picture_width, picture_height).view;
  CHECK(sunken_parts(scene, view).empty());
  scene.instances[0].selected = true;
  CHECK(sunken_parts(scene, view).size() == 1);
}

TEST_CASE("without bodies no part is drawn, around the eye all of them") {
  RenderScene scene;
  const ViewSetup empty = make_frame_setup(scene, picture_width, picture_height).view;
  CHECK(drawn_parts(scene, empty).empty());
  scene.instances.push_back(
      box_instance({scene.camera.eye, Quat::Identity()}, Vec3::Constant(0.5), Paint()));
  const FrameSetup setup = make_frame_setup(scene, picture_width, picture_height);
  const auto parts = drawn_parts(scene, setup.view);
  REQUIRE(parts.size() == 1);
  CHECK(pixels_of(parts) == picture_width * picture_height);
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
