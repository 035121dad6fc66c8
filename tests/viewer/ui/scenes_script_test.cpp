// The list of scenes with categories and pictures, and folders that are looked through for files.
// References: lists and folders made by hand; the picture that `tumble render` writes.
#include "engine/scene/pack/pack.hpp"
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/app/window/folder_browser.hpp"
#include "viewer/app/window/thumbnails.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/png.hpp"
#include "viewer/render/renderer.hpp"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

void put_file(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

const char* tiny =
    R"({"tumble_scene": 1, "title": "tiny", "settings": {"stepper": "event"}, "bodies": {
  "ball": {"shape": {"type": "sphere", "radius": 0.5}, "position": [0, 1, 0]}}})";

}  // namespace

TEST_CASE("a category narrows the list, and a search finds scenes of every one") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.play("key Ctrl+O\nwait 4");
  REQUIRE(rig.app->ui().find("scenes.first"));
  CHECK(rig.app->ui().find("scenes.second"));
  rig.play("click scenes.category.bodies\nwait 3");
  CHECK(rig.app->ui().find("scenes.first"));
  CHECK_FALSE(rig.app->ui().find("scenes.second"));
  rig.play("click scenes.search\nwait 2\ntext second\nwait 3");
  CHECK(rig.app->ui().find("scenes.second"));
  rig.play("key Enter\nwait 4");
  CHECK(rig.app->scene_name() == "second");
  rig.play("key Ctrl+O\nwait 4\nclick scenes.category.all\nwait 3");
  CHECK(rig.app->ui().find("scenes.first"));
  CHECK(rig.app->ui().find("scenes.second"));
  check_no_faults(*device);
}

TEST_CASE("folders are gone through by clicks, and a file there opens") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  put_file(rig.folder / "work/inner/mine.json", tiny);
  put_file(rig.folder / "work/notes.txt", "no scene");
  put_file(rig.folder / "work/.hidden.json", tiny);
  rig.play("key Ctrl+O\nwait 4");
  rig.app->ask(BrowseFolder{(rig.folder / "work").string()});
  rig.play("wait 3");
  REQUIRE(rig.app->browsed());
  CHECK(rig.app->browsed()->entries.size() == 1);
  rig.play(
      "click scenes.file.inner\nwait 3\nclick scenes.up\nwait 3\nclick scenes.file.inner\nwait 3");
  REQUIRE(rig.app->ui().find("scenes.file.mine.json"));
  rig.play("click scenes.file.mine.json\nwait 5");
  CHECK(rig.app->scene_name() == "mine");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::scenes));
  // Opened again the list of scenes is there.
  rig.play("key Ctrl+O\nwait 4");
  CHECK_FALSE(rig.app->browsed());
  rig.play("click scenes.files\nwait 3");
  REQUIRE(rig.app->browsed());
  rig.play("click scenes.to_scenes\nwait 3");
  CHECK_FALSE(rig.app->browsed());
  rig.app->ask(BrowseFolder{(rig.folder / "nowhere").string()});
  rig.play("wait 3");
  CHECK_FALSE(rig.app->browsed()->fault.empty());
  check_no_faults(*device);
}

TEST_CASE("a pack that is dropped on the window opens, and a damaged one is refused") {
  const auto device = make_null_device();
  Rig rig(*device);
  const char* before = std::getenv("XDG_CACHE_HOME");
  const std::string cache = before ? before : "";
  setenv("XDG_CACHE_HOME", (rig.folder / "cache").c_str(), 1);
  put_file(rig.folder / "tiny.json", tiny);
  const auto files = pack_files((rig.folder / "tiny.json").string());
  REQUIRE(files.ok());
  // Packs are known by what they hold, whatever they are called.
  const auto pack = rig.folder / "sent.json";
  REQUIRE(write_pack(pack, *files));
  rig.play("drop " + pack.string() + "\nwait 5");
  CHECK(rig.app->scene_name() == "tiny");
  // What is changed goes back into a pack, or beside the files that came with it.
  const BodyId ball = rig.app->session().world().find_body("ball");
  REQUIRE_FALSE(ball.is_null());
  rig.app->ask(EditBody{ball, "Change mass of ball", [](BodyDef& d) { d.mass = 3; }});
  rig.play("wait 2\nkey Ctrl+S\nwait 3");
  rig.app->ask(WriteScene{(rig.folder / "loose/own.json").string()});
  CHECK(read_file(rig.folder / "loose/own.json")->find("\"mass\": 3") != std::string::npos);
  rig.play("drop " + pack.string() + "\nwait 5");
  const auto mass = [&] {
    World& world = rig.app->session().world();
    return world.body(world.find_body("ball"))->mass;
  };
  CHECK(mass() != doctest::Approx(3));
  rig.app->ask(EditBody{rig.app->session().world().find_body("ball"), "Change mass of ball",
                        [](BodyDef& d) { d.mass = 3; }});
  rig.play("wait 2\nkey Ctrl+S\nwait 3\nkey Ctrl+S\nwait 3");
  CHECK(says(rig, "Saved to " + pack.string()));
  CHECK(is_pack_file(pack));
  rig.play("drop " + pack.string() + "\nwait 5");
  CHECK(mass() == doctest::Approx(3));
  std::filesystem::resize_file(pack, std::filesystem::file_size(pack) / 2);
  rig.play("drop " + pack.string() + "\nwait 5");
  CHECK(rig.app->scene_name() == "tiny");
  CHECK(says(rig, "damaged, or ends early"));
  cache.empty() ? unsetenv("XDG_CACHE_HOME") : setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  check_no_faults(*device);
}

TEST_CASE("what the window opens is known by its ending") {
  for (const char* yes : {"a.json", "A.STL", "b.tumble", "c.urdf", "d.glb"})
    CHECK(can_be_opened(yes));
  for (const char* no : {"a.txt", "json", ".json", "a.png", "a"}) CHECK_FALSE(can_be_opened(no));
}

TEST_CASE("a picture of a scene is made once, beside, and kept by what the scene's file holds") {
  const auto device = make_null_device();
  TempFolder folder;
  const auto renderer = Renderer::create(*device, *resource_path("shaders"));
  REQUIRE(renderer.ok());
  put_file(folder / "tiny.json", tiny);
  put_file(folder / "bad.json", "{");
  const std::vector<SceneItem> scenes = {{"tiny", "", "", (folder / "tiny.json").string()},
                                         {"bad", "", "", (folder / "bad.json").string()},
                                         {"no_file", "", "", ""}};
  const std::vector<std::string> seen = {"bad", "tiny", "no_file"};
  const std::filesystem::path program = std::filesystem::path(TUMBLE_BINARY_DIR) / "bin/tumble";
  const auto run = [&](Thumbnails& thumbnails) {
    double longest = 0;
    for (int i = 0;
         i < 12000 && (i < 3 || thumbnails.busy() || !thumbnails.pictures().contains("tiny"));
         ++i) {
      const auto start = std::chrono::steady_clock::now();
      thumbnails.update(scenes, seen, **renderer);
      longest = std::max(
          longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return longest;
  };
  {
    Thumbnails none(folder / "pictures", {});
    for (int i = 0; i < 5; ++i) none.update(scenes, seen, **renderer);
    CHECK(none.pictures().empty());
  }
  {
    Thumbnails thumbnails(folder / "pictures", program);
    const double longest = run(thumbnails);
    CHECK(thumbnails.pictures().contains("tiny"));
    CHECK_FALSE(thumbnails.pictures().contains("bad"));
    CHECK(thumbnails.made() == 1);
    CHECK(longest < 0.5);
  }
  size_t files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder / "pictures")) {
    const auto image = read_image(file.path());
    REQUIRE(image.ok());
    CHECK(image->width == Thumbnails::width);
    CHECK_FALSE(is_uniform(*image));
    ++files;
  }
  CHECK(files == 1);
  Thumbnails again(folder / "pictures", program);
  again.update(scenes, {"tiny"}, **renderer);
  CHECK(again.pictures().contains("tiny"));
  CHECK(again.made() == 0);
  // Looked at once more after the file has changed, it has no picture until another is made.
  again.look_again(scenes);
  CHECK(again.pictures().contains("tiny"));
  put_file(folder / "tiny.json", std::string(tiny) + "// another");
  again.look_again(scenes);
  CHECK_FALSE(again.pictures().contains("tiny"));
  check_no_faults(*device);
}
