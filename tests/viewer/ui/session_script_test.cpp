// Reference: what a person would see: ticks counted by hand, heights read from the frame; and the
// draw-list hash, which must be the same on every device for the same script.
#include "tests/support/ring_mesh.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_world.hpp"
#include "viewer/app/application.hpp"
#include "viewer/capture/png.hpp"
#include "viewer/context/gl_context.hpp"
#include "viewer/render/gl/gl_device.hpp"
#include "viewer/render/null/null_device.hpp"
#include "viewer/render/resources.hpp"

#include <cmath>
#include <cstdlib>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

OpenedScene small_scene(const std::string& name) {
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

struct Rig {
  TempFolder folder;
  std::unique_ptr<Application> app;
  Application::Picture picture{800, 500, 1};

  explicit Rig(Device& device, const std::string& scene = "first") {
    // The same letters on every machine, so that hashes can be compared.
    ApplicationOptions options;
    options.own_thread = false;
    options.threads = 1;
    options.shaders = *resource_path("shaders");
    options.scenes = {{"first", "the one that is open"}, {"second", "another one"}};
    options.capture_folder = folder.path();
    options.open = [](const std::string& name) -> Result<OpenedScene> {
      if (name != "first" && name != "second" && name != "overlays")
        return Error{ErrorCode::parse, "a.json:3: bodies.x: unknown key\na.json:9: two", {}, {}};
      return small_scene(name);
    };
    auto made = Application::create(device, std::move(options), small_scene(scene));
    REQUIRE_MESSAGE(made.ok(), made.error().text());
    app = std::move(*made);
  }

  void frame(const std::vector<InputEvent>& events = {}) {
    const Status s = app->frame(events, 1.0 / 60, picture);
    REQUIRE_MESSAGE(s.ok(), s.error().text());
  }
  void play(std::string_view text) {
    auto script = ScriptedInput::parse(text);
    REQUIRE_MESSAGE(script.ok(), script.error().text());
    while (!script->done()) {
      auto events = script->next([&](std::string_view place) { return app->locate(place); });
      REQUIRE_MESSAGE(events.ok(), events.error().text());
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

void check_no_faults(Device& device) {
  for (const std::string& fault : device.take_faults()) FAIL_CHECK(fault);
}

/// One session that touches everything; the hash of its last picture.
/// The statistics show wall times, which no two runs share: they are left out where hashes count.
uint64_t whole_session(Device& device, bool statistics) {
  Rig rig(device);
  rig.play("wait 5\nclick transport.pause");
  const uint64_t paused_at = rig.tick();
  rig.play("wait 10");
  CHECK(rig.tick() == paused_at);
  rig.play("key .");
  CHECK(rig.tick() == paused_at + 1);
  rig.play("key Shift+.");
  CHECK(rig.tick() == paused_at + 11);
  rig.play("key ,");
  CHECK(rig.tick() == paused_at + 10);
  rig.play("key R");
  CHECK(rig.tick() == 0);
  if (statistics) rig.play("key F3");
  rig.play("key Space\nkey 1\nkey 2\nkey F4\nwait 60\nclick body:box\nwait 2");
  CHECK(rig.app->selected());
  CHECK(rig.app->ui_state().shows(PanelId::inspector));
  rig.play("key Space");
  const uint64_t hash = rig.app->report().draws.hash;
  check_no_faults(device);
  return hash;
}

}  // namespace

TEST_CASE("pause, step, step back and restart by script on the null device") {
  const auto device = make_null_device();
  CHECK(whole_session(*device, true) != 0);
}

TEST_CASE("the same script draws the same list on the null device and on a real one") {
  const auto null_device = make_null_device();
  const uint64_t expected = whole_session(*null_device, false);
  auto context = create_context("auto");
  if (!context.ok()) {
    MESSAGE("no context here: ", context.error().text());
    return;
  }
  auto device = make_gl_device(*context->context);
  REQUIRE(device.ok());
  CHECK(whole_session(**device, false) == expected);
}

TEST_CASE("key 6 walks down the hierarchy and off again, the panel chooses the kind") {
  const auto device = make_null_device();
  Rig rig(*device, "meshes");
  rig.picture = {1280, 800, 1};
  const Overlays& overlays = rig.app->ui_state().overlays;
  const auto lines = [&] { return rig.app->picture().lines.size(); };
  rig.play("click transport.pause");
  const size_t without = lines();
  int depth = -1;
  for (size_t volumes = 1; depth < 100; volumes *= 2) {
    rig.play("key 6");
    if (!overlays.hierarchy) break;
    CHECK(overlays.hierarchy_level == ++depth);
    if (depth < 6) CHECK(lines() == without + 12 * volumes);
  }
  CHECK(depth >= 7);  // 1024 triangles, four to a leaf
  CHECK(lines() == without);
  rig.play("key Shift+6");
  CHECK(overlays.hierarchy);
  CHECK(overlays.hierarchy_level == depth);
  rig.play("key 0\nkey 6\nkey 6");
  CHECK(overlays.hierarchy_level == 1);
  rig.app->ui_state().shows(PanelId::drawing) = true;
  rig.play("wait 3\nclick drawing.hierarchy_kind\nwait 2\nclick drawing.hierarchy.sphere\nwait 2");
  CHECK(overlays.hierarchy_kind == "sphere");
  CHECK(lines() == without + 2 * 144);
  rig.play("key 0");
  CHECK_FALSE(overlays.hierarchy);
  CHECK(overlays.hierarchy_kind == "sphere");

  Rig none(*device);
  none.play("key 6");
  CHECK_FALSE(none.app->ui_state().overlays.hierarchy);
  CHECK(none.app->ui_state().toasts.back().title.find("mesh") != std::string::npos);
  check_no_faults(*device);
}

TEST_CASE("M puts the selected body and its neighbour under the microscope, N steps through") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 800, 1};
  const UiState& state = rig.app->ui_state();
  rig.play("click transport.pause\nkey N");
  CHECK(state.toasts.back().title.find("select a body") != std::string::npos);
  rig.play("click body:box\nwait 2\nkey M\nwait 2");
  CHECK(state.shows(PanelId::microscope));
  REQUIRE(rig.app->locate("microscope.next"));
  rig.play("key N\nkey N\nkey N");
  CHECK(state.microscope.step == 3);
  rig.play("key Shift+N");
  CHECK(state.microscope.step == 2);
  rig.play("click microscope.next\nwait 1");
  CHECK(state.microscope.step == 3);
  const size_t lines = rig.app->picture().lines.size();
  CHECK(lines > 20);
  CHECK_FALSE(rig.app->picture().plate.has_value());  // the panel has its words
  rig.play("key Tab");
  CHECK(rig.app->picture().plate.has_value());
  rig.play("key Tab\nkey Ctrl+N");
  CHECK(state.microscope.step == 0);
  rig.play("click microscope.algorithm\nwait 2\nclick microscope.time_of_contact\nwait 2");
  CHECK(state.microscope.algorithm == "time_of_contact");
  CHECK_FALSE(state.microscope.step.has_value());
  rig.play("click microscope.algorithm\nwait 2\nclick microscope.v_clip\nwait 2\nkey N");
  CHECK_FALSE(state.microscope.step.has_value());  // refused: a ball has no features
  rig.play("key M");
  CHECK_FALSE(state.shows(PanelId::microscope));
  CHECK(rig.app->picture().lines.size() < lines);
  check_no_faults(*device);
}

TEST_CASE("the mouse spring lifts a body, and it falls when it is let go") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 30\nmove body:box\npress left");
  const double before = rig.height("box");
  for (int i = 0; i < 30; ++i) rig.play("by 0 -4");
  rig.play("wait 40");
  CHECK(rig.app->dragging());
  CHECK(rig.height("box") > before + 0.5);
  const double held = rig.height("box");
  rig.play("wheel 2\nwait 10\nrelease left\nwait 60");
  CHECK_FALSE(rig.app->dragging());
  CHECK(rig.height("box") < held - 0.3);
  CHECK(rig.app->view().to->forces.empty());
  check_no_faults(*device);
}

TEST_CASE("dragging the ground orbits, and a shot makes a body") {
  const auto device = make_null_device();
  Rig rig(*device);
  const Vec3 eye = rig.app->camera().camera().eye;
  rig.play("drag 320,390 80 0 10\nwait 20");
  CHECK((rig.app->camera().camera().eye - eye).norm() > 1);
  const auto bodies = rig.app->view().to->stats.bodies;
  rig.play("shift_click body:box\nwait 2");
  CHECK(rig.app->view().to->stats.bodies == bodies + 1);
}

TEST_CASE("scenes open by search and by brackets; a faulty file is shown and the old one stays") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("key Ctrl+O\nwait 3\ntext sec\nwait 2\nkey Enter\nwait 2");
  CHECK(rig.app->scene_name() == "second");
  rig.play("key ]");
  CHECK(rig.app->scene_name() == "first");
  rig.play("drop broken.json\nwait 2");
  CHECK(rig.app->scene_name() == "first");
  REQUIRE(rig.app->ui_state().toasts.size() == 1);
  CHECK(rig.app->ui_state().toasts[0].kind == ToastKind::error);
  CHECK(rig.app->ui_state().toasts[0].lines.size() == 2);
  rig.play("key Esc");
  CHECK(rig.app->ui_state().toasts.empty());
  rig.play("drop second\nwait 2");
  CHECK(rig.app->scene_name() == "second");
}

namespace {

WorldSettings settings_of(Rig& rig) {
  auto answer = rig.app->session().call([](World& w) { return w.settings(); });
  rig.frame();
  return answer.get();
}

bool says(const Rig& rig, std::string_view words) {
  for (const Toast& toast : rig.app->ui_state().toasts) {
    if (toast.title.find(words) != std::string::npos) return true;
    for (const std::string& line : toast.lines)
      if (line.find(words) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("R keeps settings that were chosen and says so, Shift+R goes back to the scene's") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 10\nkey R\nwait 2");
  CHECK_FALSE(says(rig, "Restarted"));  // nothing was chosen
  rig.play("wait 10\nkey Space\nwait 2");
  const WorldSettings of_scene = settings_of(rig);
  REQUIRE(of_scene.broad_phase != "aabb_tree");
  rig.play("click bar.settings\nwait 3\nclick settings.broad_phase\nwait 3");
  rig.play("click settings.broad_phase.aabb_tree\nwait 3\nclick bar.settings\nwait 3");
  for (int times = 0; times < 2; ++times) {
    rig.play("key R\nwait 2");
    CHECK(rig.tick() == 0);
    CHECK(settings_of(rig).broad_phase == "aabb_tree");
    CHECK(says(rig, "Restarted with the settings chosen here"));
    CHECK(says(rig, "Kept: broad_phase"));
    rig.play("key Shift+.\nwait 2");
    CHECK(rig.tick() == 10);
  }
  rig.play("key Shift+R\nwait 2");
  CHECK(rig.tick() == 0);
  CHECK(settings_of(rig).broad_phase == of_scene.broad_phase);
  CHECK(says(rig, "Restarted as the scene has it"));
}

TEST_CASE("C brings the scene's camera back, F shows everything") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("key Space\nwait 2");
  const Vec3 eye = rig.app->camera().camera().eye, target = rig.app->camera().camera().target;
  rig.play("drag 100,400 200 40 10\nwait 60");
  CHECK((rig.app->camera().camera().eye - eye).norm() > 1);
  rig.play("key C\nwait 90");
  CHECK((rig.app->camera().camera().eye - eye).norm() < 1e-3);
  CHECK((rig.app->camera().camera().target - target).norm() < 1e-3);
  rig.app->camera().zoom(30);
  rig.play("wait 60\nkey F\nwait 90");
  for (const char* name : {"body:box", "body:ball"}) {
    const auto at = rig.app->locate(name);
    REQUIRE(at);
    CHECK((at->x > 0 && at->x < 800 && at->y > 0 && at->y < 500));
  }
}

TEST_CASE("an overlay that shows nothing says so, one that does has a legend") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 30\nkey Space\nkey 8\nwait 2");
  CHECK(says(rig, "8 is on, and shows nothing at this moment"));
  CHECK(rig.app->locate("legend"));
  rig.play("key 0\nwait 2");
  CHECK_FALSE(rig.app->locate("legend"));
  rig.app->ui_state().toasts.clear();
  rig.play("key 9\nwait 2");
  CHECK_FALSE(says(rig, "shows nothing"));
  CHECK(rig.app->locate("legend"));
  rig.app->session().post([](World& w) {
    for (const char* name : {"box", "ball"}) CHECK(w.destroy_body(w.find_body(name)).ok());
  });
  rig.play("key 9\nwait 2\nkey 9\nwait 2");  // only the ground is left
  CHECK(says(rig, "9 is on, and shows nothing"));
}

TEST_CASE("letters typed into a text field are no commands") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20\nkey Ctrl+O\nwait 3\nkey R\nkey Space\nwait 2");
  CHECK(rig.tick() > 20);
  CHECK_FALSE(rig.app->session().paused());
}

TEST_CASE("snapshot and back, delete and screenshots") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20\nkey Space\nkey F5");
  const uint64_t kept = rig.tick();
  const double height = rig.height("ball");
  rig.play("key Space\nwait 30\nkey Space\nkey F7\nwait 2");
  CHECK(rig.tick() == kept);
  CHECK(rig.height("ball") == height);
  const auto bodies = rig.app->view().to->stats.bodies;
  rig.play("click body:box\nkey Del\nwait 2\nkey F12\nkey Ctrl+F12\nwait 2");
  CHECK(rig.height("box") == -1);
  CHECK(bodies == 3);
  REQUIRE(rig.app->captured().size() == 2);
  for (const auto& path : rig.app->captured()) {
    const auto image = read_image(path);
    REQUIRE(image.ok());
    CHECK(image->width == 800);
    CHECK(image->height == 500);
  }
}

TEST_CASE("a camera that follows a body goes along with it, however it has been turned") {
  const auto device = make_null_device();
  Rig rig(*device, "following");
  const auto eye = [&] { return rig.app->camera().camera().eye; };
  const auto fallen = [&] { return 4 - rig.height("ball"); };
  rig.play("wait 30");
  REQUIRE(fallen() > 0.5);
  CHECK((eye() - Vec3(0, 2 - fallen(), 9)).norm() < 1e-9);
  rig.play("key Space\ndrag 320,390 80 0 10\nwait 60");
  const Vec3 turned = eye();
  const double before = fallen();
  CHECK((turned - Vec3(0, 2 - before, 9)).norm() > 1);
  rig.play("key Shift+.\nwait 2");
  CHECK((eye() - (turned - Vec3(0, fallen() - before, 0))).norm() < 1e-4);
  rig.play("key R\nwait 2");
  CHECK((eye() - (turned + Vec3(0, before, 0))).norm() < 1e-4);
  const Vec3 start = eye();
  rig.app->session().post([](World& w) { CHECK(w.destroy_body(w.find_body("ball")).ok()); });
  rig.play("wait 5\nkey Space\nwait 5");
  CHECK(rig.height("ball") == -1);
  CHECK((eye() - start).norm() < 1e-4);
}

TEST_CASE("Shift while a body is held turns it, and flying moves the eye") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 30");
  const auto box = *rig.app->locate("body:box");
  const auto turned = [&] {
    const Frame& f = *rig.app->view().to;
    for (size_t slot = 0; slot < f.body_slots(); ++slot)
      if (f.info(slot).name == "box") return 2 * std::asin(f.body(slot).pose.q.y());
    return 0.0;
  };
  rig.frame({PointerMoved{box.x, box.y}, PointerPressed{PointerButton::left, true}});
  for (int i = 1; i <= 40; ++i) rig.frame({PointerMoved{box.x, box.y - 2 * i}});
  rig.frame({KeyPressed{Key::shift, true, false}});
  const double before = turned();
  for (int i = 1; i <= 20; ++i) rig.frame({PointerMoved{box.x + 5 * i, box.y - 80}});
  CHECK(turned() - before > 0.3);
  rig.frame({KeyPressed{Key::shift, false, false}, PointerPressed{PointerButton::left, false}});
  CHECK_FALSE(rig.app->dragging());

  const Vec3 eye = rig.app->camera().camera().eye;
  rig.frame({PointerPressed{PointerButton::right, true}});
  rig.frame({KeyPressed{letter_key('W'), true, false}});
  for (int i = 0; i < 20; ++i) rig.frame();
  rig.frame({KeyPressed{letter_key('W'), false, false}});
  rig.frame({PointerPressed{PointerButton::right, false}});
  for (int i = 0; i < 60; ++i) rig.frame();
  const Vec3 moved = rig.app->camera().camera().eye - eye;
  CHECK(moved.z() < -1);
  CHECK(std::abs(moved.x()) < 0.3);
}

TEST_CASE("what is typed right behind Ctrl+O goes into the search and is no command") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20");
  // All within one picture, as on a machine that draws slowly.
  rig.frame({KeyPressed{Key::control, true, false}, KeyPressed{letter_key('O'), true, false},
             KeyPressed{letter_key('O'), false, false}, KeyPressed{Key::control, false, false},
             KeyPressed{letter_key('R'), true, false}, TextTyped{'s'},
             KeyPressed{letter_key('R'), false, false}});
  rig.frame({TextTyped{'e'}});
  rig.frame({TextTyped{'c'}});
  rig.play("wait 3");
  CHECK(rig.app->ui_state().search == "sec");
  CHECK(rig.tick() > 20);
  // Leaving it gives the keys back at once.
  rig.frame({KeyPressed{Key::escape, true, false}, KeyPressed{Key::escape, false, false},
             KeyPressed{f_key(3), true, false}, KeyPressed{f_key(3), false, false}});
  CHECK(rig.app->ui_state().shows(PanelId::statistics));
  rig.frame({KeyPressed{f_key(4), true, false}, KeyPressed{f_key(4), false, false}});
  CHECK(rig.app->ui_state().shows(PanelId::energy));
}

TEST_CASE("a sequence keeps its size while the window changes, and ends whole with the program") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 5\nkey F9\nwait 3");
  rig.picture = {501, 333, 1};
  rig.play("wait 3");
  CHECK(rig.app->recording());
  rig.app->finish();
  CHECK_FALSE(rig.app->recording());
  size_t pictures = 0, lists = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(rig.folder.path())) {
    lists += entry.path().filename() == "frames.json";
    if (entry.path().extension() != ".png") continue;
    ++pictures;
    const auto image = read_image(entry.path());
    REQUIRE(image.ok());
    CHECK(image->width == 800);
    CHECK(image->height == 500);
  }
  CHECK(pictures >= 6);
  CHECK(lists == 1);
}

TEST_CASE("a double click makes the point the pivot, the wheel pulls what is held, middle pans") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20\ndouble_click body:box\nwait 60");
  CHECK((rig.app->camera().pivot() - Vec3(0, 0.5, 0)).norm() < 0.9);
  CHECK((rig.app->camera().camera().eye - Vec3(0, 2, 9)).norm() < 0.01);
  const auto depth = [&] {
    const auto id = rig.app->selected();
    const auto slot = find_slot(*rig.app->view().to, id);
    return slot ? rig.app->view().to->body(*slot).pose.x.z() : 0;
  };
  rig.play("move body:box\npress left\nby 0 -30\nby 0 -30\nwait 40");
  const double before = depth();
  rig.play("wheel 3\nwait 40");
  CHECK(depth() > before + 0.5);
  rig.play("wheel -6\nwait 40");
  CHECK(depth() < before - 0.5);
  rig.play("release left\nwait 2");
  const Vec3 pivot = rig.app->camera().pivot();
  rig.play("move 320,390\npress middle\nby 50 0\nrelease middle");
  CHECK((rig.app->camera().pivot() - pivot).norm() > 0.2);
}

TEST_CASE("a double click makes a body the pivot wherever it is seen, in windows large and small") {
  const auto device = make_null_device();
  for (const Application::Picture& picture :
       {Application::Picture{1280, 720, 1}, Application::Picture{420, 320, 1},
        Application::Picture{1600, 1200, 2}})
    for (double side = -4; side <= 4; side += 0.5) {
      CAPTURE(picture.width);
      CAPTURE(side);
      Rig rig(*device);
      rig.picture = picture;
      rig.play("wait 2");
      Camera camera;
      camera.eye = Vec3(side, 2, 9);
      camera.target = Vec3(side, 1.2, 0);
      rig.app->camera().set(camera);
      rig.frame();
      const auto at = rig.app->locate("body:box");
      REQUIRE(at);
      if (at->x < 0 || at->x >= picture.width / picture.scale) continue;
      rig.play("click body:box\nwait 8\nclick body:box\nwait 5");  // 8 pictures are 0.13 s
      CHECK((rig.app->camera().pivot() - Vec3(0, 0.5, 0)).norm() < 0.9);
      CHECK(rig.app->selected());
      // What opens by itself covers no more than an edge of the picture.
      CHECK(rig.app->ui_state().shows(PanelId::inspector) == (picture.width > 420));
    }
}

TEST_CASE("clicks far apart in time or place are no double click, and a panel keeps its own") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("wait 20");
  Camera camera;
  camera.eye = Vec3(-3.5, 2, 9);
  camera.target = Vec3(-3.5, 1.2, 0);
  rig.app->camera().set(camera);
  rig.frame();
  const auto at = rig.app->locate("body:box");
  REQUIRE(at);
  REQUIRE(at->x > 1000);  // where the panel of the body opens
  rig.play("click body:box\nwait 30\nclick body:box\nwait 30");
  CHECK((rig.app->camera().pivot() - camera.target).norm() < 1e-9);
  CHECK(rig.app->selected());
  rig.play("click 500,150\nwait 30");
  CHECK_FALSE(rig.app->selected());
  // At once after a click on the body, but elsewhere: on the panel.
  rig.app->ui_state().shows(PanelId::inspector) = false;
  rig.play("wait 2\nclick body:box\nclick inspector.close");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::inspector));
}

TEST_CASE("key 4 draws friction cones, of the selected body alone, and 0 takes them away") {
  const auto device = make_null_device();
  Rig rig(*device);
  const auto lines = [&] { return rig.app->picture().lines.size(); };
  rig.play("wait 90\nclick transport.pause");
  REQUIRE(lines() == 0);
  const uint64_t without = rig.app->report().draws.hash;
  constexpr size_t lines_of_cone = 16 + 4 + 1;
  rig.play("key 4");
  const size_t all = lines();
  CHECK(all >= 5 * lines_of_cone);  // the box on four corners, the ball on a point
  CHECK(all % lines_of_cone == 0);
  CHECK(rig.app->report().draws.hash != without);
  rig.play("click body:ball\nwait 2");
  CHECK(lines() == lines_of_cone);
  rig.play("key Esc");
  CHECK(lines() == all);
  rig.play("key 0");
  CHECK(lines() == 0);
  check_no_faults(*device);
}

TEST_CASE("a message lies over the panels of a small window, also over one that was clicked") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {420, 320, 1};
  rig.app->ui_state().toasts.clear();
  rig.app->ui_state().shows(PanelId::drawing) = true;
  rig.play("wait 3\nclick panel.drawing\nwait 2\ndrop bad.json\nwait 5");
  REQUIRE(rig.app->ui_state().toasts.size() == 1);
  const auto panel = rig.app->ui().find("panel.drawing"),
             close = rig.app->ui().find("toast0.close");
  REQUIRE(panel);
  REQUIRE(close);
  REQUIRE(panel->overlaps(*close));
  rig.play("click toast0.close\nwait 2");
  CHECK(rig.app->ui_state().toasts.empty());
}

TEST_CASE("a sequence has one frame a sixtieth of a second and goes on where it was") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 5\nkey F9\nwait 9\nkey F9\nwait 2");
  size_t pictures = 0;
  bool told = false;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(rig.folder.path())) {
    if (entry.path().extension() == ".png") ++pictures;
    if (entry.path().filename() == "frames.json") told = true;
  }
  CHECK(pictures >= 9);
  CHECK(told);
  CHECK_FALSE(rig.app->session().paused());
}

TEST_CASE("a click on a drawn contact shows what it claims, under both steppers") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 800, 1};
  const auto contact = [&] { return rig.app->contact(); };
  const double weight =
      rig.app->view().to->info(1).mass * rig.app->view().to->gravity.norm();  // of the box
  rig.play("wait 20\nclick transport.pause\nclick contact\nwait 3");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::contact));  // nothing was drawn there
  rig.play("key 1\nclick contact\nwait 3");
  REQUIRE(rig.app->ui_state().shows(PanelId::contact));
  REQUIRE(contact());
  REQUIRE(contact()->certificate);
  CHECK(contact()->certificate->solver == "realtime");
  CHECK_FALSE(contact()->balance_b);
  CHECK(contact()->certificate->force.norm() < weight);

  rig.app->session().post([](World& world) {
    WorldSettings settings = world.settings();
    settings.stepper = "event";
    REQUIRE(world.set_settings(settings).ok());
  });
  rig.play("key .\nwait 3");
  REQUIRE(contact());
  REQUIRE(contact()->certificate);
  CHECK(contact()->certificate->mode == ContactMode::sticking);
  CHECK(contact()->certificate->residual < 1e-9);
  REQUIRE(contact()->balance_b);
  CHECK(std::abs(contact()->balance_b->contact_force.y() / weight - 1) < 1e-9);
  CHECK(contact()->balance_b->residual < 1e-9);
  rig.play("click contact.b\nwait 2");
  CHECK(rig.app->selected() == contact()->pick.b);

  rig.play("key Del\nwait 3");
  REQUIRE(contact());
  CHECK_FALSE(contact()->certificate);
  rig.play("key Esc\nwait 2");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::contact));
  CHECK_FALSE(contact());
  check_no_faults(*device);
}

TEST_CASE(
    "overlays of a scene come and go with it, those that a person chose stay; trails follow") {
  const auto device = make_null_device();
  Rig rig(*device);
  const auto& on = rig.app->ui_state().overlays;
  rig.play("wait 2\nkey 1\nwait 2");
  CHECK(on.contacts);
  CHECK_FALSE(on.joints);
  rig.play("drop overlays\nwait 40");
  CHECK(on.contacts);
  CHECK(on.joints);
  const size_t lines = rig.app->picture().lines.size();
  CHECK(lines > 20);  // the ball has fallen
  rig.play("key Space\nwait 2\nkey Shift+,\nwait 2");
  CHECK(rig.app->picture().lines.size() < lines);
  rig.play("drop second\nwait 20");
  CHECK(on.contacts);
  CHECK_FALSE(on.joints);
  CHECK(rig.app->picture().lines.empty());
  check_no_faults(*device);
}

TEST_CASE("who goes back into a drag finds the body let go") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 30\nmove body:box\npress left");
  for (int i = 0; i < 30; ++i) rig.play("by 0 -4");
  rig.play("wait 20");
  REQUIRE(rig.app->view().to->forces.size() == 1);
  rig.play("release left\nwait 5\nkey Space\nwait 2");
  CHECK(rig.app->view().to->forces.empty());
  rig.play("key Shift+,\nwait 2\nkey Shift+,\nwait 2");
  CHECK(rig.app->view().to->forces.empty());
  const double held = rig.height("box");
  REQUIRE(held > 1);
  rig.play("key Space\nwait 60");
  CHECK(rig.height("box") < held - 0.3);
  // While it is held, too.
  rig.play("move body:box\npress left");
  for (int i = 0; i < 30; ++i) rig.play("by 0 -4");
  rig.play("key Shift+,\nwait 2");
  CHECK_FALSE(rig.app->dragging());
  CHECK(rig.app->view().to->forces.empty());
  check_no_faults(*device);
}

TEST_CASE("what was changed in a pause is there when one comes back to it") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20\nkey Space\nwait 2\nclick body:box\nkey Del\nwait 2");
  REQUIRE(rig.height("box") == -1);
  rig.play("key Shift+.\nwait 2\nkey Shift+,\nwait 2");
  CHECK(rig.height("box") == -1);
  rig.play("key ,\nwait 2");
  CHECK(rig.height("box") > 0);
  rig.play("key R\nwait 2");
  CHECK(rig.height("box") > 0);
}

TEST_CASE("a setting that the world refuses is said and not shown") {
  const auto device = make_null_device();
  Rig rig(*device);
  const WorldSettings before = settings_of(rig);
  // As typed over the slider: the stepper has no such algorithm.
  WorldSettings wrong = before;
  wrong.event.integrator = "no_such_integrator";
  rig.app->ask(ChangeSettings{wrong});
  rig.play("wait 3");
  CHECK(says(rig, "This setting is not possible"));
  CHECK(rig.app->settings().event.integrator == before.event.integrator);
  CHECK(settings_of(rig).event.integrator == before.event.integrator);
  WorldSettings right = before;
  right.gravity = Vec3(0, -1.6, 0);
  rig.app->ask(ChangeSettings{right});
  rig.play("wait 3");
  CHECK(rig.app->settings().gravity == right.gravity);
}

TEST_CASE("F shows the scene and not what has flown away") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("key Space\nwait 2");
  rig.app->session().post([](World& w) {
    Pose far;
    far.x = Vec3(1e6, 4e5, 0);
    CHECK(w.set_pose(w.find_body("ball"), far).ok());
  });
  rig.play("wait 2\nkey F\nwait 90");
  const Camera& camera = rig.app->camera().camera();
  CHECK((camera.eye - camera.target).norm() < 20);
  const auto at = rig.app->locate("body:box");
  REQUIRE(at);
  CHECK((at->x > 0 && at->x < 800 && at->y > 0 && at->y < 500));
}
