// Changes of the description while the session is busy with a slow tick, and after they were saved.
// Reference: the file as it would be written by hand, byte for byte.
#include "tests/viewer/ui/described.hpp"

#include <chrono>
#include <filesystem>
#include <future>
#include <thread>
#include <utility>

using namespace tumble;
using namespace tumble::test;

namespace {

/// The two bodies with a session of its own thread that is busy until it is let go.
struct Busy {
  std::unique_ptr<Device> device = make_null_device();
  Rig rig{*device, "first", true};
  std::string file = (rig.folder.path() / "mine.json").string();
  std::string start = "{\n  \"tumble_scene\": 1,\n" + two_bodies + "\n}\n";
  std::promise<void> let_go;
  bool busy = true;

  Busy() {
    REQUIRE(write_file(file, std::string_view(start)).ok());
    rig.app->open(file);
    wait_for([&] { return rig.app->scene_name() != "first" && rig.tick() > 0; });
    rig.app->session().post([until = let_go.get_future().share()](World&) { until.wait(); });
  }
  ~Busy() { end(); }
  void end() {
    if (std::exchange(busy, false)) let_go.set_value();
  }
  template <class Holds>
  void wait_for(const Holds& holds) {
    for (int i = 0; i < 2000 && !holds(); ++i) {
      rig.frame();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    REQUIRE(holds());
  }
  void set_radius(const char* value) {
    rig.app->ask(EditDescription{ScenePath{} / "bodies" / "ball" / "shape" / "radius",
                                 EditDescription::How::set, value});
  }
  /// What is kept of unsaved work; "": nothing.
  std::string kept() const {
    if (!std::filesystem::exists(rig.unsaved())) return {};
    for (const auto& one : std::filesystem::directory_iterator(rig.unsaved()))
      if (one.path().extension() == ".json") return *read_file(one.path());
    return {};
  }
};

}  // namespace

TEST_CASE("description: what is changed in a slow tick is kept at once, and when one quits then") {
  Busy b;
  b.set_radius("0.25");
  b.set_radius("0.125");
  const std::string changed = with(b.start, "0.5 }", "0.125 }");
  CHECK(b.kept() == changed);
  // Who quits now is told that it is kept, and it is.
  b.rig.play("key Ctrl+Q\nwait 3");
  CHECK(b.rig.app->locate("question.quit").has_value());
  b.rig.play("click question.quit\nwait 2");
  CHECK(b.rig.app->quit_requested());
  CHECK(b.kept() == changed);
  // Set back by hand there is nothing to keep, before the session has answered and after.
  b.set_radius("0.5");
  CHECK(b.kept().empty());
  b.end();
  for (int i = 0; i < 40; ++i) {
    b.rig.frame();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  CHECK(b.kept().empty());
  check_no_faults(*b.device);
}

TEST_CASE("description: a change that is taken back before the session has answered is not kept") {
  Busy b;
  b.set_radius("0.25");
  REQUIRE_FALSE(b.kept().empty());
  b.rig.play("key Ctrl+Z\nwait 2");
  b.end();
  b.wait_for([&] { return b.kept().empty(); });
  check_no_faults(*b.device);
}

TEST_CASE("description: what is changed in a slow tick is done to a file that others change then") {
  Busy b;
  b.set_radius("0.25");
  const std::string others = with(b.start, "\"wood\"", "\"steel\"");
  REQUIRE(write_file(b.file, std::string_view(others)).ok());
  for (int i = 0; i < 60; ++i) b.rig.frame();  // its file is looked at four times a second
  b.end();
  b.wait_for([&] { return b.kept() == with(others, "0.5 }", "0.25 }"); });
  check_no_faults(*b.device);
}

TEST_CASE("description: what was saved is a part of the text that is changed next") {
  Described b(two_bodies);
  b.rig.app->ask(
      EditBody{b.world().find_body("ball"), "Change mass of ball", [](BodyDef& d) { d.mass = 3; }});
  b.play("wait 70");
  const std::string saved = b.saved();
  REQUIRE(saved.find("\"mass\": 3") != std::string::npos);
  b.go("cameras.main");
  b.type_in("position.x", "1");
  b.play("wait 4");
  CHECK(*b.world().body_def(b.world().find_body("ball"))->mass == 3);
  CHECK(b.saved() == with(saved, "[0, 2.5, 9]", "[1, 2.5, 9]"));
  check_no_faults(*b.device);
}
