// Liquids and smoke before they reach a device. References: the law of Beer and Lambert, geometry
// by hand, Galileo's principle (a liquid that moves as a whole does not foam).
#include "engine/core/random.hpp"
#include "tests/support/why_not.hpp"
#include "viewer/render/foam.hpp"
#include "viewer/render/frame_setup.hpp"
#include "viewer/render/null/null_device.hpp"
#include "viewer/render/renderer.hpp"
#include "viewer/render/resources.hpp"
#include "viewer/render/smoke_puffs.hpp"
#include "viewer/render/soft_plan.hpp"
#include "viewer/render/sun_veil.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// A slab of a liquid 1 m wide with its surface at y = 0, so and so deep.
FluidSurface slab(double depth, double spacing = 0.05) {
  FluidSurface fluid;
  fluid.colour = Vec3f(0.1f, 0.5f, 0.9f);
  fluid.clarity = 0.5f;
  fluid.radius = float(0.85 * spacing);
  const double r = double(fluid.radius);
  fluid.fill = float(spacing * spacing * spacing / (4 * M_PI / 3 * r * r * r));
  for (double y = -0.5 * spacing; y > -depth; y -= spacing)
    for (double x = 0.5 * spacing; x < 1; x += spacing)
      for (double z = 0.5 * spacing; z < 1; z += spacing)
        fluid.particles.push_back({Vec3(x, y, z).cast<float>(), fluid.radius, 0});
  return fluid;
}

Vec3f left_at(const SunVeil& veil, const Vec3& x) {
  const Vec4 p = veil.veil_from_world * Vec4(x[0], x[1], x[2], 1);
  const auto place = [&](double u) {
    return size_t(std::clamp(int(u * veil.size), 0, veil.size - 1));
  };
  const uint32_t c = veil.cells[place(p.y()) * size_t(veil.size) + place(p.x())];
  return Vec3f(float(c & 255), float(c >> 8 & 255), float(c >> 16 & 255)) / 255;
}

SmokePuff puff_at(const Vec3f& x, float opacity = 0.5f) {
  SmokePuff p;
  p.centre = x;
  p.radius = 0.4f;
  p.opacity = opacity;
  return p;
}

/// Value noise at one point, its eight corners hashed anew (the mixing of splitmix64).
float noise_at(const Vec3f& x, uint32_t seed) {
  const auto smooth = [](float t) { return t * t * (3 - 2 * t); };
  float sum = 0;
  for (int c = 0; c < 8; ++c) {
    const std::array<int, 3> step{c & 1, c >> 1 & 1, c >> 2};
    std::array<uint64_t, 3> corner{};
    float weight = 1;
    for (int k = 0; k < 3; ++k) {
      const float low = std::floor(x[k]), t = smooth(x[k] - low);
      weight *= step[size_t(k)] ? t : 1 - t;
      corner[size_t(k)] = uint32_t(int(low) + step[size_t(k)]);
    }
    uint64_t h = corner[0] * 0x9E3779B97F4A7C15u ^ corner[1] * 0xC2B2AE3D27D4EB4Fu ^
                 corner[2] * 0x165667B19E3779F9u ^ uint64_t(seed) << 32;
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9u;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBu;
    sum += weight * float((h ^ (h >> 31)) >> 40) / 16777216.0f;
  }
  return sum;
}

}  // namespace

TEST_CASE(
    "a slab of liquid leaves of the sun what Beer and Lambert say, and its surface takes a part") {
  for (const double depth : {0.25, 0.5, 1.0}) {
    RenderScene scene;
    scene.fluids.push_back(slab(depth));
    SunVeil veil;
    make_sun_veil(scene, Vec3::UnitY(), everywhere(), 256, veil);
    REQUIRE(veil.size == 256);
    // The mean over the middle: single cells see the gaps between balls.
    Vec3 mean = Vec3::Zero();
    int n = 0;
    for (double x = 0.3; x < 0.7; x += 0.01)
      for (double z = 0.3; z < 0.7; z += 0.01, ++n)
        mean += left_at(veil, Vec3(x, -2, z)).cast<double>();
    mean /= n;
    const double by_surface = 0.75;
    for (int k = 0; k < 3; ++k) {
      const double expected = by_surface * std::pow(double(scene.fluids[0].colour[k]), depth / 0.5);
      CHECK(mean[k] == doctest::Approx(expected).epsilon(0.12).scale(0.1));
    }
    // Depth from the sun: the surface first.
    const Vec4 top = veil.veil_from_world * Vec4(0.5, 0, 0.5, 1);
    CHECK(top.z() > 0);
    CHECK(top.z() < 0.1);
    CHECK(left_at(veil, Vec3(-5, 0, 0)) == Vec3f::Ones());
  }
}

TEST_CASE("of puffs behind one another each has less sun, and the one beside them all of it") {
  RenderScene scene;
  for (int i = 0; i < 4; ++i) scene.smoke.push_back(puff_at(Vec3f(0, float(i), 0)));
  scene.smoke.push_back(puff_at(Vec3f(5, 0, 0)));
  SunVeil veil;
  make_sun_veil(scene, Vec3::UnitY(), everywhere(), 256, veil);
  CHECK(veil.smoke_light[4] == doctest::Approx(1));
  CHECK(veil.smoke_light[3] == doctest::Approx(1));
  for (int i = 0; i < 3; ++i) CHECK(veil.smoke_light[size_t(i)] < veil.smoke_light[size_t(i + 1)]);
  CHECK(left_at(veil, Vec3(0, -1, 0)).x() < left_at(veil, Vec3(5, -1, 0)).x());
}

TEST_CASE("the planned balls of a liquid: all in the picture, those in front first") {
  RenderScene scene;
  scene.camera.eye = Vec3(0.5, 3, 0.5001);
  scene.camera.target = Vec3(0.5, 0, 0.5);
  scene.fluids.push_back(slab(0.5));
  const FrameSetup setup = make_frame_setup(scene, 400, 400);
  std::vector<GpuFluidParticle> vertices;
  const LiquidPlan plan = plan_liquid(scene.fluids[0], setup.view, vertices);
  CHECK(plan.all == scene.fluids[0].particles.size());
  CHECK(vertices.size() == 3 * plan.all);
  CHECK(plan.front >= 400);  // the top layer
  CHECK(plan.front < plan.all / 2);
  int top = 0;
  for (uint32_t i = 0; i < plan.front; ++i) top += vertices[3 * i].centre[1] > -0.03f;
  CHECK(top == 400);
}

TEST_CASE("whatever a veil can shade lies in the part of the picture that is given for it") {
  Random r(8);
  int seen = 0, parts = 0;
  for (int i = 0; i < 200; ++i) {
    RenderScene scene;
    scene.sun.to_sun = Vec3(r.uniform(-1, 1), r.uniform(0.1, 1), r.uniform(-1, 1));
    scene.ground.height = r.uniform(-1, 0);
    scene.camera.eye = Vec3(r.uniform(-6, 6), r.uniform(0.2, 4), r.uniform(4, 9));
    scene.camera.target = Vec3(r.uniform(-3, 3), 0, 0);
    for (int k = 0; k < 3; ++k)
      scene.smoke.push_back(puff_at(Vec3f(float(r.uniform(-1, 1)), float(r.uniform(0, 2)), 0)));
    const FrameSetup setup = make_frame_setup(scene, 640, 360);
    const Vec3 to_sun = scene.sun.to_sun.normalized();
    SunVeil veil;
    make_sun_veil(scene, to_sun, setup.region, 64, veil);
    const auto area = shaded_area(veil, to_sun, setup.lowest, setup.view);
    parts += area && area->width * area->height < 640 * 360;
    // Points of the puffs, moved away from the sun for as long as they are above the ground.
    for (int k = 0; k < 100; ++k) {
      const Vec3f& centre = scene.smoke[r.below(3)].centre;
      Vec3 x =
          centre.cast<double>() + 0.2 * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
      x -= to_sun * (r.uniform() * std::max(x.y() - scene.ground.height, 0.0) / to_sun.y());
      const Vec4 clip = setup.view.clip_from_world * Vec4(x[0], x[1], x[2], 1);
      if (clip.head<3>().cwiseAbs().maxCoeff() > clip.w()) continue;
      const double column = 320 * (clip.x() / clip.w() + 1), row = 180 * (1 - clip.y() / clip.w());
      REQUIRE(area.has_value());
      CHECK(column >= area->x);
      CHECK(column <= area->x + area->width);
      CHECK(row >= area->y);
      CHECK(row <= area->y + area->height);
      ++seen;
    }
  }
  CHECK(seen > 5000);
  CHECK(parts > 100);
}

TEST_CASE("smoke is drawn from far to near, without what the camera does not see") {
  RenderScene scene;
  scene.camera.eye = Vec3(0, 0, 10);
  scene.camera.target = Vec3::Zero();
  for (const float z : {0.f, 4.f, -3.f, 2.f, 60.f}) scene.smoke.push_back(puff_at(Vec3f(0, 0, z)));
  scene.smoke.push_back(puff_at(Vec3f(0, 0, 1), 0));
  const FrameSetup setup = make_frame_setup(scene, 320, 180);
  const auto puffs = plan_smoke(scene, setup.view, {});
  REQUIRE(puffs.size() == 4);
  CHECK(puffs[0].place[2] == -3);
  CHECK(puffs[3].place[2] == 4);
}

/// How many of the parts hold a place of the picture [px].
int parts_at(const std::vector<ScissorRect>& parts, double column, double row) {
  return int(std::count_if(parts.begin(), parts.end(), [&](const ScissorRect& p) {
    return column >= p.x && column < p.x + p.width && row >= p.y && row < p.y + p.height;
  }));
}

TEST_CASE("what a puff covers, or shades, lies in one of the parts that are given for smoke") {
  Random r(5);
  int seen = 0, shaded = 0, parted = 0;
  for (int trial = 0; trial < 200; ++trial) {
    RenderScene scene;
    scene.camera.eye = Vec3(r.uniform(-3, 3), r.uniform(-2, 3), r.uniform(1, 8));
    for (int k = 0; k < 2; ++k)
      scene.smoke.push_back(puff_at(Vec3f(float(r.uniform(-2, 2)), float(r.uniform(-1, 2)), 0)));
    const FrameSetup setup = make_frame_setup(scene, 640, 360);
    const auto puffs = plan_smoke(scene, setup.view, {});
    SmokeShade shade;
    shade.falls = trial % 2 == 1;
    shade.to_sun = Vec3(r.uniform(-1, 1), r.uniform(0.2, 1), r.uniform(-1, 1)).normalized();
    shade.lowest = -1.5;
    const auto parts = smoke_parts(scene, puffs, shade, setup.view);
    if (!shade.falls) CHECK(parts.empty() == puffs.empty());
    int pixels = 0;
    for (const ScissorRect& p : parts) pixels += p.width * p.height;
    parted += pixels < 640 * 360 / 2;
    const auto check = [&](const Vec3& x, int& count) {
      const Vec4 clip = setup.view.clip_from_world * Vec4(x.x(), x.y(), x.z(), 1);
      if (clip.head<3>().cwiseAbs().maxCoeff() >= clip.w()) return;
      CHECK(parts_at(parts, 320 * (clip.x() / clip.w() + 1), 180 * (1 - clip.y() / clip.w())) == 1);
      ++count;
    };
    for (int k = 0; k < 50 && !puffs.empty(); ++k) {
      // Points of the cards, which face the eye, and of what is behind one of them for the sun.
      const auto& place = puffs[r.below(uint32_t(puffs.size()))].place;
      const Vec3 centre = Vec3f(place[0], place[1], place[2]).cast<double>();
      const Vec3 ahead = (centre - setup.view.eye).normalized();
      const Vec3 right = ahead.cross(setup.view.up).normalized(), up = right.cross(ahead);
      const double angle = r.uniform(0, 2 * M_PI), reach = r.uniform() * double(place[3]);
      check(centre + reach * (std::cos(angle) * right + std::sin(angle) * up), seen);
      if (!shade.falls) continue;
      const Vec3 side = shade.to_sun.cross(Vec3::UnitX()).normalized();
      const double way = r.uniform(0, std::max(centre.y() - shade.lowest, 0.0) / shade.to_sun.y());
      check(centre - way * shade.to_sun + reach * std::cos(angle) * side, shaded);
    }
  }
  CHECK(seen > 3000);
  CHECK(shaded > 1000);
  CHECK(parted > 30);
}

TEST_CASE("liquid that moves as a whole does not foam, where streams meet it does") {
  std::vector<Vec3> x;
  std::vector<Vec3f> together, meeting;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) {
        x.push_back(0.1 * Vec3(i, j, k));
        together.push_back(Vec3f(7, -3, 2));
        meeting.push_back(Vec3f(i < 10 ? 1.f : -1.f, 0, 0));
      }
  const std::vector<float> share(x.size(), 0.8f), inside(x.size(), 1);
  const auto most = [](const std::vector<float>& foam) {
    return *std::max_element(foam.begin(), foam.end());
  };
  const LiquidNeighbours near(x, 0.1);
  CHECK(most(foam_of(near, together, share)) == 0);
  const auto broken = foam_of(near, meeting, share);
  CHECK(broken[size_t(9 * 36 + 15)] > 0.2f);  // at the seam
  CHECK(broken[15] == 0);                     // at an end
  CHECK(most(foam_of(near, meeting, inside)) == 0);
  const std::vector<float> alone(x.size(), 0.05f);
  CHECK(foam_of(near, together, alone)[0] == 1);
  CHECK(foam_of(LiquidNeighbours({}, 0.1), {}, {}).empty());
}

TEST_CASE("puffs are dense in the middle and gone at the rim of their pictures") {
  const PuffAtlas atlas = make_puff_atlas();
  const int tile = atlas.size / 2;
  for (int kind = 0; kind < 4; ++kind) {
    const int x0 = kind % 2 * tile, y0 = kind / 2 * tile;
    const auto alpha = [&](int x, int y) {
      return int(atlas.texels[size_t((y0 + y) * atlas.size + x0 + x)] >> 24);
    };
    double middle = 0;
    for (int y = tile / 2 - 8; y < tile / 2 + 8; ++y)
      for (int x = tile / 2 - 8; x < tile / 2 + 8; ++x) middle += alpha(x, y) / 256.0;
    CHECK(middle > 100);
    for (int i = 0; i < tile; ++i)
      CHECK(alpha(i, 0) + alpha(i, tile - 1) + alpha(0, i) + alpha(tile - 1, i) < 8);
  }
}

TEST_CASE("how dense a puff is follows from three octaves of noise along the line of sight") {
  const PuffAtlas atlas = make_puff_atlas();
  const int tile = atlas.size / 2, slices = 14;
  const auto place = [&](int i) { return (float(i) + 0.5f) / float(tile) * 2 - 1; };
  int some = 0;
  for (int kind = 0; kind < 4; ++kind)
    for (int j = 3; j < tile; j += 11)
      for (int i = 5; i < tile; i += 7) {
        const float x = place(i), y = place(j), half = std::sqrt(std::max(1 - x * x - y * y, 0.f));
        float left = 1;
        for (int s = 0; s < slices && half > 0; ++s) {
          const Vec3f at(x, y, half * (1 - 2 * (float(s) + 0.5f) / float(slices)));
          float sum = 0;
          for (uint32_t o = 0; o < 3; ++o)
            sum += std::ldexp(1.f, -1 - int(o)) *
                   noise_at(Vec3f(std::pow(2.1f, float(o)) * 2.3f * at + Vec3f(7, 13, 19)),
                            uint32_t(100 * kind + 1) + o);
          const float dense = std::max(0.f, (1 - at.squaredNorm()) * (sum * 3.4f - 0.95f));
          left /= 1 + dense * 8 * half / float(slices);
        }
        const int row = (j + kind / 2 * tile) * atlas.size;
        const int alpha = int(atlas.texels[size_t(row + i + kind % 2 * tile)] >> 24);
        CHECK(std::abs(float(alpha) - 255 * (1 - left)) < 0.6f);
        some += alpha > 20 && alpha < 235;
      }
  CHECK(some > 300);
}

TEST_CASE("targets that a picture has no use for are not made") {
  auto device = make_null_device();
  auto renderer = Renderer::create(*device, *resource_path("shaders"));
  REQUIRE(renderer.ok());
  RenderScene scene;
  const auto live = [&] {
    REQUIRE((*renderer)->render(scene, 320, 180).ok());
    return device->stats().live_resources;
  };
  const uint32_t bare = live();
  CHECK(live() == bare);
  scene.smoke.push_back(puff_at(Vec3f(0, 1, 0)));
  const uint32_t smoke = live();  // solid depth, smoke, atlas and veil, two targets of one texture
  CHECK(smoke == bare + 6);
  scene.fluids.push_back(slab(0.1));
  const uint32_t both = live();  // behind, front, other and thickness, each with its texture
  CHECK(both == smoke + 8);
  scene.texts.emplace_back();
  scene.texts[0].text = "a";
  CHECK(live() == both + 2);  // the picture that words are drawn over
  CHECK(live() == both + 2);
  for (const std::string& fault : device->take_faults()) FAIL_CHECK(fault);
}

TEST_CASE(
    "liquid and smoke draw without a fault in every quality, hostile ones too, and leak nothing") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  auto device = make_null_device();
  {
    auto renderer = Renderer::create(*device, *resource_path("shaders"));
    REQUIRE(renderer.ok());
    RenderScene scene;
    scene.camera.eye = Vec3(2, 2, 4);
    scene.fluids.push_back(slab(0.3));
    for (int i = 0; i < 5; ++i) scene.smoke.push_back(puff_at(Vec3f(0, float(i), 0)));
    uint64_t hash = 0;
    for (const Quality q : {Quality::draft, Quality::standard, Quality::high}) {
      scene.quality = q;
      auto report = (*renderer)->render(scene, 320, 180);
      REQUIRE_MESSAGE(report.ok(), test::why_not(report));
      CHECK(report->draws.hash != hash);
      hash = report->draws.hash;
      CHECK((*renderer)->render(scene, 320, 180)->draws.hash == hash);
    }
    scene.fluids[0].particles[0].centre.x() = nan;
    scene.fluids[0].particles[1].radius = nan;
    scene.fluids.emplace_back();
    scene.smoke.push_back(puff_at(Vec3f(nan, 0, 0)));
    scene.smoke.push_back(puff_at(Vec3f(2, 2, 4)));  // around the eye
    CHECK((*renderer)->render(scene, 1, 1).ok());
    scene.camera.eye = Vec3(double(nan), 0, 0);
    CHECK((*renderer)->render(scene, 33, 17).ok());
    scene.sun.shadows = false;
    scene.camera.eye = Vec3(0.5, -0.1, 0.5);  // within the liquid
    CHECK((*renderer)->render(scene, 33, 17).ok());
  }
  for (const std::string& fault : device->take_faults()) FAIL_CHECK(fault);
  CHECK(device->stats().live_resources == 0);
}
