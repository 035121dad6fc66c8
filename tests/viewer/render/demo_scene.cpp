#include "tests/viewer/render/demo_scene.hpp"

#include "engine/core/random.hpp"
#include "engine/math/det/det.hpp"
#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/font.hpp"

#include <array>
#include <cmath>

namespace tumble::test {
namespace {

const std::array<uint32_t, 6> palette = {0xE4572E, 0xF3A712, 0x2E4A7D,
                                         0x669BBC, 0xEDE6D6, 0x3E8E6E};

Quat turn(const Vec3& axis, double angle) {
  const Vec3 v = axis.normalized() * det::sin(0.5 * angle);
  return Quat(det::cos(0.5 * angle), v.x(), v.y(), v.z());
}

Paint random_paint(Random& random) {
  Paint m;
  m.colour = linear_from_srgb(palette[random.below(palette.size())]);
  m.roughness = float(random.uniform(0.25, 0.7));
  return m;
}

/// A round tower of bricks, every layer turned by half a brick.
void add_tower(RenderScene& s, Random& random, int bricks) {
  constexpr int around = 12;
  for (int i = 0; i < bricks; ++i) {
    const int layer = i / around;
    const double a = (i % around + 0.5 * (layer % 2)) * 2 * det::pi / around;
    const Pose pose{Vec3(2 * det::cos(a), 0.2 + 0.4 * layer, 2 * det::sin(a)),
                    turn(Vec3::UnitY(), -a + random.uniform(-0.03, 0.03))};
    s.instances.push_back(box_instance(pose, Vec3(0.2, 0.199, 0.46), random_paint(random)));
  }
}

/// Bodies lying around the tower at places of their own.
void add_scatter(RenderScene& s, Random& random, int count) {
  std::vector<Vec3> taken;
  for (int tries = 0; count > 0 && tries < 100000; ++tries) {
    const double a = random.uniform(0, 2 * det::pi);
    const double r = 3.2 + 0.012 * tries;
    const Vec3 at(r * det::cos(a), 0, r * det::sin(a));
    bool free = true;
    for (const Vec3& t : taken) free = free && (t - at).norm() > 1.05;
    if (!free) continue;
    taken.push_back(at);
    --count;
    const double size = random.uniform(0.15, 0.4);
    const Quat yaw = turn(Vec3::UnitY(), random.uniform(0, 6.28));
    const Quat lying = yaw * turn(Vec3::UnitX(), det::pi / 2);
    Paint m = random_paint(random);
    switch (random.below(4)) {
      case 0:
        m.pattern = Pattern::quarters;
        s.instances.push_back(sphere_instance({at + Vec3(0, size, 0), yaw * lying}, size, m));
        break;
      case 1:
        s.instances.push_back(box_instance({at + Vec3(0, size, 0), yaw}, Vec3::Constant(size), m));
        break;
      case 2:
        s.instances.push_back(
            capsule_instance({at + Vec3(0, 0.5 * size, 0), lying}, 0.5 * size, 0.6 * size, m));
        break;
      default:
        s.instances.push_back(
            cylinder_instance({at + Vec3(0, 0.7 * size, 0), yaw}, 0.8 * size, 0.7 * size, m));
    }
  }
}

}  // namespace

RenderScene demo_scene(int count) {
  Random random(7);
  RenderScene s;
  const int bricks = count * 2 / 5 / 12 * 12;
  add_tower(s, random, bricks);
  add_scatter(s, random, count - bricks - 1);
  Paint metal;
  metal.colour = linear_from_srgb(0xC9CCD1);
  metal.metallic = 1;
  metal.roughness = 0.25f;
  s.instances.push_back(sphere_instance({Vec3(-3.0, 0.8, 3.6), Quat::Identity()}, 0.8, metal));
  s.camera.eye = Vec3(7.5, 4.6, 9.5);
  s.camera.target = Vec3(0, 1.0, 0);
  return s;
}

RenderScene soft_scene() {
  Random random(11);
  RenderScene s;
  FluidSurface water;
  water.radius = 0.085f;
  water.clarity = 0.8f;
  water.fill = 0.39f;
  for (int i = 0; i < 30; ++i)
    for (int k = 0; k < 20; ++k) {
      const int layers = 5 + int(std::lround(2 * det::sin(0.4 * i) * det::cos(0.3 * k)));
      for (int j = 0; j < layers; ++j)
        water.particles.push_back(
            {Vec3f(0.1f * float(i) - 1.5f, 0.05f + 0.1f * float(j), 0.1f * float(k) - 1), 0.085f,
             i > 22 ? 0.8f : 0.f});
    }
  s.fluids.push_back(std::move(water));
  s.instances.push_back(box_instance({Vec3(0.2, 0.5, 0.5), turn(Vec3(1, 2, 0), 0.5)},
                                     Vec3(0.3, 0.3, 0.3), random_paint(random)));
  s.instances.push_back(box_instance({Vec3(-1.9, 0.5, 0), Quat::Identity()}, Vec3(0.2, 0.5, 1),
                                     random_paint(random)));
  for (uint32_t i = 0; i < 60; ++i) {
    SmokePuff p;
    p.centre = Vec3f(float(random.uniform(-1.5, 0)), float(random.uniform(0.8, 2.2)),
                     float(random.uniform(-0.6, 0.6)));
    p.radius = float(random.uniform(0.3, 0.6));
    p.opacity = 0.3f;
    p.turn = float(random.uniform(0, 6));
    p.kind = i;
    s.smoke.push_back(p);
  }
  s.legends.push_back({"water: speed", "m/s", 0, 3});
  s.camera.eye = Vec3(2.2, 2.3, 4.2);
  s.camera.target = Vec3(0, 0.6, 0);
  return s;
}

void add_marks(RenderScene& s) {
  s.instances.front().selected = true;
  s.lines.push_back({Vec3f(0, 0, 0), Vec3f(0, 4, 0), Vec4f(0.1f, 0.9f, 0.2f, 1), 2});
  s.lines.push_back(
      {Vec3f(0, 0, 0), Vec3f(4, 0, 0), Vec4f(0.9f, 0.1f, 0.1f, 1), 2, Occlusion::none});
  s.points.push_back({Vec3f(1, 1.5f, 1), Vec4f(1, 0.8f, 0, 1), 9, Occlusion::none});
  for (int i = 0; i < 40; ++i)
    s.spheres.push_back({Vec3f(0.15f * float(i) - 3, 3.4f, 0), 0.07f, Vec4f(0.1f, 0.4f, 0.8f, 1)});
  TextLabel label;
  label.text = "Tumble: 9.81 m/s\xC2\xB2";
  label.x = Vec3f(0, 4.1f, 0);
  s.texts.push_back(label);
  Paint ghost;
  ghost.colour = Vec3f(0.2f, 0.6f, 0.9f);
  ghost.opacity = 0.35f;
  s.instances.push_back(
      box_instance({Vec3(3, 0.6, 3), Quat::Identity()}, Vec3(0.6, 0.6, 0.6), ghost));
  // A panel as an immediate-mode UI hands it over: two triangles in the font's white texel.
  const FontAtlas font = bake_default_font();
  const auto corner = [&](float x, float y) {
    return UiVertex{x, y, font.white_u, font.white_v, 0xC0302820};
  };
  s.ui.vertices = {corner(10, 10), corner(150, 10), corner(150, 60), corner(10, 60)};
  s.ui.indices = {0, 1, 2, 0, 2, 3};
  s.ui.draws = {{0, 6, 0, {0, 0, 140, 1000}, 0}};
}

}  // namespace tumble::test
