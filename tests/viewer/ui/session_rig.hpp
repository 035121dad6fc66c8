#pragma once
#include "tests/support/ring_mesh.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"
#include "viewer/app/window/application.hpp"
#include "viewer/app/window/open_scene.hpp"
#include "viewer/render/null/null_device.hpp"
#include "viewer/render/resources.hpp"

#include <doctest/doctest.h>

namespace tumble::test {

inline OpenedScene small_scene(const std::string& name) {
  TestWorld w;
  ShapeDef floor;
  floor.type = ShapeType::half_space;
  BodyDef ground = TestWorld::shape_def(floor, Vec3::Zero(), BodyType::fixed);
  ground.name = "ground";
  (void)w.add(ground);
  BodyDef box = TestWorld::box_def({0, 0.5, 0});
  box.name = "box";
  (void)w.add(box);
  BodyDef ball = TestWorld::sphere_def({2, 4, 0});
  ball.name = "ball";
  (void)w.add(ball);
  if (name == "meshes") {
    ShapeDef ring;
    ring.type = ShapeType::triangle_mesh;
    ring.mesh = std::make_shared<const TriangleMesh>(ring_mesh(0.6, 0.2, 32, 16));
    BodyDef body = TestWorld::shape_def(ring, Vec3(-2, 2, 0), BodyType::kinematic);
    body.name = "ring";
    (void)w.add(body);
  }
  OpenedScene scene;
  scene.view.follow = name == "following" ? w->find_body("ball") : BodyId{};
  scene.view.follow_x = Vec3(2, 4, 0);
  scene.world = std::move(w.world);
  scene.name = name;
  scene.request.scene = name;
  scene.parameters = {{"count", "how many boxes", 3, 1, 10},
                      {"gap", "between them [m]", 0.5, {}, {}}};
  Camera camera;
  camera.eye = Vec3(0, 2, 9);
  camera.target = Vec3(0, 1.2, 0);
  scene.view.camera = camera;
  if (name == "overlays") {
    scene.overlays.joints = true;
    scene.trail = 1;
  }
  return scene;
}

/// The program without a window, played by scripts of pointer and keys.
struct Rig {
  TempFolder folder;
  std::unique_ptr<Application> app;
  std::vector<std::string> wished;  ///< overrides of the scene that was opened last
  Application::Picture picture{800, 500, 1};

  explicit Rig(Device& device, const std::string& scene = "first", bool own_thread = false) {
    // The same letters on every machine, so that hashes can be compared.
    ApplicationOptions options;
    options.own_thread = own_thread;
    options.threads = 1;
    options.shaders = *resource_path("shaders");
    options.scenes = {{"first", "the one that is open", "bodies", ""},
                      {"second", "another one", "fluids", "", "The title of second"}};
    options.preferences_file = folder.path() / "config/window.json";
    options.capture_folder = folder.path();
    options.unsaved_folder = unsaved();
    options.open = [this](const OpenRequest& wanted) -> Result<OpenedScene> {
      const std::string& name = wanted.scene;
      wished = wanted.overrides;
      if ((name.ends_with(".json") || name.ends_with(".tumble")) && std::filesystem::exists(name))
        return open_scene(SceneRequest{name, wanted.overrides, wanted.text, {}, 1, {}, {}}, 1.6);
      if (name != "first" && name != "second" && name != "overlays")
        return Error{ErrorCode::parse, "a.json:3: bodies.x: unknown key\na.json:9: two", {}, {}};
      return small_scene(name);
    };
    auto made = Application::create(device, std::move(options), small_scene(scene));
    REQUIRE_MESSAGE(made.ok(), test::why_not(made));
    app = std::move(*made);
  }

  /// Where it keeps what was not saved.
  std::filesystem::path unsaved() const { return folder.path() / "unsaved"; }
  void frame(const std::vector<InputEvent>& events = {}) {
    const Status s = app->frame(events, 1.0 / 60, picture);
    REQUIRE_MESSAGE(s.ok(), test::why_not(s));
  }
  void play(std::string_view text) {
    auto script = ScriptedInput::parse(text);
    REQUIRE_MESSAGE(script.ok(), test::why_not(script));
    while (!script->done()) {
      auto events = script->next([&](std::string_view place) { return app->locate(place); });
      REQUIRE_MESSAGE(events.ok(), test::why_not(events));
      frame(*events);
    }
    frame();
    frame();
  }
  uint64_t tick() const { return app->view().to->tick; }
  double height(std::string_view name) const {
    const Frame& f = *app->view().to;
    for (size_t slot = 0; slot < f.body_slots(); ++slot)
      if (f.info(slot).name == name) return f.body(slot).pose.x.y();
    return -1;
  }
};

inline void check_no_faults(Device& device) {
  for (const std::string& fault : device.take_faults()) FAIL_CHECK(fault);
}

inline bool says(const Rig& rig, std::string_view words) {
  for (const Toast& toast : rig.app->ui_state().toasts) {
    if (toast.title.find(words) != std::string::npos) return true;
    for (const std::string& line : toast.lines)
      if (line.find(words) != std::string::npos) return true;
  }
  return false;
}

}  // namespace tumble::test
