// The renderer on the validating device. Reference: the device's own rules, and counts by hand.
#include "tests/support/why_not.hpp"
#include "tests/viewer/render/demo_scene.hpp"
#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/null/null_device.hpp"
#include "viewer/render/renderer.hpp"
#include "viewer/render/resources.hpp"

#include <limits>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

struct Studio {
  std::unique_ptr<Device> device = make_null_device();
  std::unique_ptr<Renderer> renderer;
  Studio() {
    auto made = Renderer::create(*device, *resource_path("shaders"));
    REQUIRE(made.ok());
    renderer = std::move(*made);
  }
  FrameReport render(const RenderScene& scene, int w = 320, int h = 180) {
    auto report = renderer->render(scene, w, h);
    REQUIRE_MESSAGE(report.ok(), test::why_not(report));
    return *report;
  }
};

}  // namespace

TEST_CASE("every kind of content draws without a fault, and nothing leaks") {
  auto device = make_null_device();
  {
    auto renderer = Renderer::create(*device, *resource_path("shaders"));
    REQUIRE(renderer.ok());
    RenderScene scene = test::demo_scene();
    test::add_marks(scene);
    for (const Quality q : {Quality::draft, Quality::standard, Quality::high}) {
      scene.quality = q;
      auto report = (*renderer)->render(scene, 320, 180);
      REQUIRE_MESSAGE(report.ok(), test::why_not(report));
      CHECK(report->visible_instances + report->culled_instances ==
            scene.instances.size() + scene.spheres.size());
      CHECK(report->visible_instances > 100);
    }
    Image image;
    CHECK((*renderer)->read_back(image).ok());
    CHECK(image.pixels.size() == 320u * 180 * 4);
    (*renderer)->forget_unused_meshes(0);
  }
  CHECK(device->take_faults().empty());
  CHECK(device->stats().live_resources == 0);
}

TEST_CASE("an empty scene is ground and sky") {
  Studio s;
  const FrameReport r = s.render({});
  CHECK(r.draws.draws == 2);
  RenderScene bare;
  bare.ground.visible = false;
  CHECK(s.render(bare).draws.draws == 1);
}

TEST_CASE("bodies of one shape are one draw, whatever their size") {
  RenderScene scene;
  scene.sun.shadows = false;
  scene.ground.visible = false;
  scene.camera.eye = Vec3(0, 3, 20);
  for (int i = 0; i < 50; ++i)
    scene.instances.push_back(box_instance({Vec3(0.1 * i - 2.5, 1, 0), Quat::Identity()},
                                           Vec3(1, 1 + 0.01 * i, 1), Paint()));
  Studio s;
  CHECK(s.render(scene, 1280, 720).draws.draws == 2);  // boxes, sky
}

TEST_CASE("the same scene has the same draw-list hash, another scene another") {
  RenderScene scene = test::demo_scene();
  Studio a, b;
  const uint64_t first = a.render(scene).draws.hash;
  CHECK(first == a.render(scene).draws.hash);
  CHECK(first == b.render(scene).draws.hash);
  scene.instances[3].transform.offset.x() += 0.001f;
  CHECK(first != a.render(scene).draws.hash);
}

TEST_CASE("what stands still is not drawn again, and what moves is") {
  RenderScene scene = test::demo_scene();
  Studio s;
  const DrawStats first = s.render(scene).draws;
  CHECK(first.kept == 0);
  const DrawStats again = s.render(scene).draws;
  CHECK(again.hash == first.hash);
  CHECK(again.draws == first.draws);
  // All but two of the contact shade, which is drawn into one target, blurred into another, and
  // blurred back. The world is the picture: nothing is resolved.
  const uint32_t world = first.passes - 2;
  CHECK(again.kept == world);

  // Words are drawn over the picture: it is resolved anew below them, but not drawn anew.
  scene.texts.push_back({"still", true, Vec3f(0, 1, 0)});
  s.render(scene);
  CHECK(s.render(scene).draws.kept == world);
  const uint32_t still = world + 1;  // from here on the picture is a target of its own

  scene.texts.clear();
  s.render(scene);
  scene.instances[3].transform.offset.x() += 0.001f;
  CHECK(s.render(scene).draws.kept == 0);
  CHECK(s.render(scene).draws.kept == still);
  CHECK(s.render(scene, 321, 180).draws.kept == 0);

  scene = test::soft_scene();
  s.render(scene);
  const DrawStats soft = s.render(scene).draws;
  Studio fresh;
  CHECK(soft.hash == fresh.render(scene).draws.hash);
}

TEST_CASE("a world of fewer pixels: same bodies, same words, at any quality and size") {
  RenderScene scene = test::demo_scene();
  test::add_marks(scene);
  Studio s;
  for (const Quality q : {Quality::draft, Quality::standard}) {
    scene.quality = q;
    scene.resolution = 1;
    const FrameReport whole = s.render(scene);
    for (const float resolution : {0.84f, 0.5f, 0.01f}) {
      scene.resolution = resolution;
      const FrameReport part = s.render(scene);
      CHECK(part.draws.hash != whole.draws.hash);
      CHECK(part.draws.passes == whole.draws.passes + 1);
      CHECK(s.render(scene).draws.hash == part.draws.hash);
    }
    scene.resolution = 0.5f;
    s.render(scene, 1, 1);
    s.render(scene, 3, 200);
    scene.resolution = 1;
    CHECK(s.render(scene).draws.hash == whole.draws.hash);
  }
}

TEST_CASE("hostile scenes are drawn without a fault") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  RenderScene scene;
  scene.instances.push_back(sphere_instance({}, 1, Paint()));
  scene.instances.push_back(scene.instances[0]);
  scene.instances.back().transform.offset.x() = nan;
  scene.instances.push_back(scene.instances[0]);
  scene.instances.back().mesh = nullptr;
  scene.instances.push_back(box_instance({}, Vec3::Zero(), Paint()));
  scene.instances.push_back(capsule_instance({}, 1e8, 0, Paint()));
  scene.instances.push_back(sphere_instance({Vec3(1e12, 0, 0), Quat::Identity()}, 1, Paint()));
  scene.spheres.push_back({Vec3f(nan, 0, 0), 1, Vec4f::Ones()});
  scene.spheres.push_back({Vec3f(0, 0, 0), nan, Vec4f::Ones()});
  scene.texts.push_back({});
  scene.texts.push_back({"\xFF\xC3", true, Vec3f(0, 1, 0)});
  scene.texts.push_back({"x", true, Vec3f(nan, 1, 0)});
  scene.ui.draws.push_back({0, 0, 0, {0, 0, 10, 10}, 0});
  Studio s;
  s.render(scene);
  scene.camera.eye = scene.camera.target;
  s.render(scene);
  scene.camera.fov_deg = 0;
  scene.sun.to_sun = Vec3::Zero();
  s.render(scene, 1, 1);
  scene.camera.eye = Vec3(nan, 0, 0);
  s.render(scene, 1, 16384);
  CHECK_FALSE(s.renderer->render(scene, 0, 10).ok());
  CHECK_FALSE(s.renderer->render(scene, 10, 20000).ok());
  s.render(scene);
}

TEST_CASE("a missing shader folder is an error with its name") {
  auto device = make_null_device();
  auto renderer = Renderer::create(*device, "/nonexistent");
  REQUIRE_FALSE(renderer.ok());
  CHECK(renderer.error().text().find("/nonexistent") != std::string::npos);
  CHECK(device->stats().live_resources == 0);
}
