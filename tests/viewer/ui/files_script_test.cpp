// Reference: the files themselves, written and read by the test.
#include "engine/world/world.hpp"
#include "tests/viewer/ui/laboratory.hpp"
#include "viewer/app/editing/unsaved_work.hpp"
#include "viewer/app/window/file_watch.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr std::string_view two_bodies = R"({
  "tumble_scene": 1,
  // A note of the author.
  "bodies": {
    "floor": { "type": "static", "shape": { "type": "half_space" } },
    "crate": { "position": [0, 0.5, 0], "shape": { "type": "box", "size": [1, 1, 1] } },
    "pile": { "position": [3, 0.5, 0], "shape": { "type": "box", "size": [1, 1, 1] } }
  },
  "cameras": { "main": { "position": [1, 2, 9], "target": [1, 1, 0] } }
}
)";

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

void write(const std::filesystem::path& file, std::string_view text) {
  REQUIRE(write_file(file, text).ok());
}

BodyDef def_of(Rig& rig, std::string_view name) {
  World& world = rig.app->session().world();
  const auto def = world.body_def(world.find_body(name));
  REQUIRE_MESSAGE(def.has_value(), name);
  return *def;
}

/// The scene of the test, opened from its file.
struct FileRig : Rig {
  std::filesystem::path file;
  explicit FileRig(Device& device) : Rig(device), file(folder.path() / "my_scene.json") {
    write(file, two_bodies);
    open();
  }
  void open() {
    app->open(file.string());
    play("wait 3\nkey Space\nwait 3");
    REQUIRE(app->scene_name() == "my_scene");
  }
  void delete_crate() {
    play("click body:crate\nwait 2\nkey Del\nwait 2");
    REQUIRE(app->session().world().find_body("crate").is_null());
  }
};

}  // namespace

TEST_CASE("a file that another program writes is seen once, when it is whole") {
  const TempFolder folder;
  const auto file = folder.path() / "a.json";
  write(file, "one");
  FileWatch watch;
  watch.open(file, "one");
  for (int i = 0; i < 5; ++i) CHECK_FALSE(watch.look(0.3));
  write(file, "one and two");
  CHECK_FALSE(watch.look(0.1));  // not looked at yet
  CHECK_FALSE(watch.look(0.3));  // may still be written
  CHECK(watch.look(0.3) == "one and two");
  CHECK_FALSE(watch.look(0.3));
  // Written anew with the same text, taken away and put back: nothing has changed.
  write(file, "one and two");
  std::filesystem::remove(file);
  for (int i = 0; i < 3; ++i) CHECK_FALSE(watch.look(0.3));
  write(file, "one and two");
  for (int i = 0; i < 3; ++i) CHECK_FALSE(watch.look(0.3));
  watch.open(file, "three");  // we write it ourselves
  write(file, "three");
  for (int i = 0; i < 3; ++i) CHECK_FALSE(watch.look(0.3));
}

TEST_CASE("two writes of one length within the grain of the file system's clock are both seen") {
  const TempFolder folder;
  const auto file = folder.path() / "a.json";
  write(file, "one");
  const auto time = std::filesystem::last_write_time(file);
  FileWatch watch;
  watch.open(file, "one");
  for (const char* text : {"two", "six", "ten"}) {
    write(file, text);
    std::filesystem::last_write_time(file, time);  // as a coarse clock leaves it
    CHECK(watch.look(0.3) == text);
    CHECK_FALSE(watch.look(0.3));
  }
}

TEST_CASE("a scene that was written by an editor is shown anew at the same moment") {
  const auto device = make_null_device();
  FileRig rig(*device);
  rig.play("key Shift+.\nwait 3");
  const uint64_t tick = rig.tick();
  REQUIRE(tick >= 10);
  rig.app->camera().orbit(60, 10);
  rig.play("wait 60");
  const Vec3 eye = rig.app->camera().camera().eye;
  write(rig.file, replaced(std::string(two_bodies), "[3, 0.5, 0]", "[2, 0.5, 0]"));
  rig.play("wait 60");
  CHECK(says(rig, "has changed: opened anew"));
  CHECK(def_of(rig, "pile").pose.x.x() == doctest::Approx(2));
  CHECK(rig.tick() == tick);
  CHECK(rig.app->session().paused());
  CHECK((rig.app->camera().camera().eye - eye).norm() < 1e-6);
  // Faults are shown, and the scene stays: nothing was opened.
  rig.app->ui_state().toasts.clear();
  write(rig.file, replaced(std::string(two_bodies), "\"half_space\"", "\"half_pace\""));
  rig.play("wait 60");
  CHECK(says(rig, "half_pace"));
  CHECK_FALSE(says(rig, "opened anew"));
  CHECK(def_of(rig, "pile").pose.x.x() == doctest::Approx(2));
  write(rig.file, two_bodies);
  rig.play("wait 60");
  CHECK(def_of(rig, "pile").pose.x.x() == doctest::Approx(3));
  check_no_faults(*device);
}

TEST_CASE("a storm of saves ends with the newest") {
  const auto device = make_null_device();
  FileRig rig(*device);
  for (int i = 0; i < 40; ++i) {
    const std::string text = i % 7 == 3 ? "{"
                                        : replaced(std::string(two_bodies), "[3, 0.5, 0]",
                                                   "[" + std::to_string(2 + i) + ", 0.5, 0]");
    write(rig.file, text);
    rig.play("wait " + std::to_string(i % 5));
  }
  rig.play("wait 60");
  CHECK(def_of(rig, "pile").pose.x.x() == doctest::Approx(41));
  check_no_faults(*device);
}

TEST_CASE("what was changed here is done to the new text too") {
  const auto device = make_null_device();
  FileRig rig(*device);
  rig.delete_crate();
  rig.play("wait 80");
  write(rig.file, replaced(std::string(two_bodies), "[3, 0.5, 0]", "[2, 0.5, 0]"));
  rig.play("wait 60");
  CHECK(says(rig, "with what was changed here"));
  CHECK(rig.app->session().world().find_body("crate").is_null());
  CHECK(def_of(rig, "pile").pose.x.x() == doctest::Approx(2));
  // What was done before the file changed is taken back in the new text, and done again.
  rig.play("key Ctrl+Z\nwait 6");
  CHECK(says(rig, "Taken back: Delete crate"));
  CHECK_FALSE(rig.app->session().world().find_body("crate").is_null());
  CHECK(def_of(rig, "pile").pose.x.x() == doctest::Approx(2));
  CHECK_FALSE(rig.app->ui().find("question.take_up"));
  rig.play("key Ctrl+Y\nwait 6");
  CHECK(rig.app->session().world().find_body("crate").is_null());
  // Saved, it holds both.
  rig.play("key Ctrl+S\nwait 3\nkey Ctrl+S\nwait 60");
  const std::string saved = *read_file(rig.file);
  CHECK(saved.find("crate") == std::string::npos);
  CHECK(saved.find("[2, 0.5, 0]") != std::string::npos);
  CHECK(saved.find("A note of the author") != std::string::npos);
  check_no_faults(*device);
}

TEST_CASE("every change by others is taken up beside what was changed here, not only the first") {
  const auto device = make_null_device();
  FileRig rig(*device);
  rig.delete_crate();
  rig.play("wait 80");
  std::string text = replaced(std::string(two_bodies), "[3, 0.5, 0]", "[2, 0.5, 0]");
  write(rig.file, text);
  rig.play("wait 60");
  CHECK(says(rig, "with what was changed here"));
  // A fault is named with its line, and what was changed here stays.
  write(rig.file, replaced(text, "[1, 2, 9]", ""));
  rig.play("wait 60");
  CHECK(says(rig, "my_scene.json:9"));
  CHECK(rig.app->session().world().find_body("crate").is_null());
  // Mended, and changed again.
  for (const char* place : {"[4, 0.5, 0]", "[5, 0.5, 0]"}) {
    text = replaced(std::string(two_bodies), "[3, 0.5, 0]", place);
    write(rig.file, text);
    rig.play("wait 60");
    CHECK(rig.app->session().world().find_body("crate").is_null());
    CHECK(def_of(rig, "pile").pose.x.x() == doctest::Approx(place[1] - '0'));
  }
  // What was changed here is taken back in the newest text, and done again.
  rig.play("key Ctrl+Z\nwait 6");
  CHECK_FALSE(rig.app->session().world().find_body("crate").is_null());
  CHECK(def_of(rig, "pile").pose.x.x() == doctest::Approx(5));
  rig.play("key Ctrl+Y\nwait 6\nkey Ctrl+S\nwait 3\nkey Ctrl+S\nwait 60");
  const std::string saved = *read_file(rig.file);
  CHECK(saved.find("crate") == std::string::npos);
  CHECK(saved.find("[5, 0.5, 0]") != std::string::npos);
  check_no_faults(*device);
}

TEST_CASE("a line that was changed here and by others is nobody's without a word") {
  const auto device = make_null_device();
  FileRig rig(*device);
  rig.delete_crate();
  rig.play("wait 80");
  const std::string first = replaced(std::string(two_bodies), "[3, 0.5, 0]", "[2, 0.5, 0]");
  write(rig.file, first);
  rig.play("wait 60");
  write(rig.file, replaced(first, "\"crate\": { \"position\": [0, 0.5, 0]",
                           "\"crate\": { \"position\": [0, 0.7, 0]"));
  rig.play("wait 60");
  CHECK(says(rig, "changed by somebody else"));
  CHECK(says(rig, "other changes of the same lines"));
  CHECK(rig.app->session().world().find_body("crate").is_null());
  check_no_faults(*device);
}

TEST_CASE("work that was not saved is there after the program was killed") {
  const auto device = make_null_device();
  const TempFolder elsewhere;
  const auto file = elsewhere.path() / "scene.json";
  write(file, two_bodies);
  {
    Rig rig(*device);
    rig.app->open(file.string());
    rig.play("wait 3\nkey Space\nwait 3\nclick body:crate\nwait 2\nkey Del\nwait 80");
    CHECK(std::filesystem::exists(rig.unsaved()));
    std::filesystem::copy(rig.unsaved(), elsewhere.path() / "unsaved");
    // Taken back there is nothing to keep.
    rig.play("key Ctrl+Z\nwait 80");
    CHECK(std::filesystem::is_empty(rig.unsaved()));
  }
  // It is known whether the file is newer, and would be replaced.
  UnsavedWork work(elsewhere.path() / "unsaved");
  work.open(
      {.path = file, .read_from = file, .text = *read_file(file), .on_disk = *read_file(file)},
      false);
  REQUIRE(work.kept().has_value());
  CHECK_FALSE(work.kept()->older);
  const auto written = std::filesystem::last_write_time(file);
  std::filesystem::last_write_time(file, written + std::chrono::hours(1));
  CHECK(work.kept()->older);
  std::filesystem::last_write_time(file, written);
  Rig rig(*device);
  std::filesystem::copy(elsewhere.path() / "unsaved", rig.unsaved());
  rig.app->open(file.string());
  rig.play("wait 6\nclick question.take_up\nwait 6");
  CHECK(rig.app->session().world().find_body("crate").is_null());
  CHECK_FALSE(rig.app->session().world().find_body("pile").is_null());
  // It is asked about before one leaves; and it is saved into the scene's own file.
  rig.play("key Ctrl+Q\nwait 3");
  CHECK_FALSE(rig.app->quit_requested());
  rig.play("click question.save\nwait 5\nkey Ctrl+S\nwait 60");
  CHECK(read_file(file)->find("crate") == std::string::npos);
  CHECK(std::filesystem::is_empty(rig.unsaved()));
  rig.play("key Ctrl+Q\nwait 3");
  CHECK(rig.app->quit_requested());
  check_no_faults(*device);
}

TEST_CASE("two windows on one file keep their unsaved work apart until one of them is gone") {
  const TempFolder folder;
  const auto scene = folder.path() / "scene.json";
  const auto file = [&](const char* text) {
    SceneFile out;
    out.path = out.read_from = scene;
    out.text = text;
    out.on_disk = "saved";
    return out;
  };
  auto first = std::make_unique<UnsavedWork>(folder.path() / "unsaved");
  UnsavedWork second(folder.path() / "unsaved");
  first->open(file("of the first"), false);
  second.open(file("saved"), false);
  CHECK_FALSE(second.kept().has_value());  // its window is there
  second.open(file("of the second"), false);
  const auto count = [&] {
    size_t n = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "unsaved"))
      n += entry.path().extension() == ".json";
    return n;
  };
  CHECK(count() == 2);
  // Saved by one, that of the other stays.
  second.saved(file("of the second"));
  CHECK(count() == 1);
  first.reset();  // as a crash leaves it
  second.open(file("saved"), false);
  const auto left = second.kept();
  REQUIRE(left.has_value());
  CHECK(left->text == "of the first");
  CHECK_FALSE(left->own);
  second.take_over(*left);
  UnsavedWork third(folder.path() / "unsaved");
  third.open(file("saved"), false);
  CHECK_FALSE(third.kept().has_value());
  // Who goes on with it keeps it there, and who comes back to it hears that it is their own.
  second.open(file("of the first, and more"), true);
  CHECK(count() == 1);
  second.open(file("saved"), false);
  REQUIRE(second.kept().has_value());
  CHECK(second.kept()->own);
  second.throw_away(second.kept()->file);
  CHECK(std::filesystem::is_empty(folder.path() / "unsaved"));
}

TEST_CASE("a number of the scene is chosen at the moment that is shown, and taken back there") {
  const auto device = make_null_device();
  FileRig rig(*device);
  rig.picture = {1600, 900, 1};
  write(rig.file, replaced(std::string(two_bodies), "\"bodies\": {",
                           "\"parameters\": { \"high\": 3, \"twice\": \"= 2*high\" },\n  "
                           "\"bodies\": {\n    \"ball\": { \"position\": [-2, \"$high\", 0], "
                           "\"shape\": { \"type\": \"sphere\", \"radius\": 0.3 } },"));
  rig.play("wait 60\nclick bar.settings\nwait 3");
  REQUIRE(rig.app->ui().find("parameters.high"));
  CHECK_FALSE(rig.app->ui().find("parameters.twice"));
  rig.delete_crate();
  rig.play("wait 80\nkey Shift+.\nwait 3");
  const uint64_t tick = rig.tick();
  REQUIRE(tick >= 10);
  rig.app->ask(ChangeParameter{"high", 5});
  rig.play("wait 6");
  CHECK(rig.tick() == tick);
  CHECK(def_of(rig, "ball").pose.x.y() > 3);
  CHECK(rig.app->session().world().find_body("crate").is_null());
  rig.play("key Shift+.\nwait 3\nkey Ctrl+Z\nwait 6");
  CHECK(says(rig, "Taken back: Change high"));
  CHECK(rig.tick() == tick);
  CHECK(def_of(rig, "ball").pose.x.y() < 3);
  rig.play("key Ctrl+Z\nwait 6");
  CHECK(says(rig, "Taken back: Delete crate"));
  CHECK_FALSE(rig.app->session().world().find_body("crate").is_null());
  // Nobody was away: nothing is offered that was taken back just now.
  CHECK_FALSE(rig.app->ui().find("question.take_up"));
  CHECK(std::filesystem::is_empty(rig.unsaved()));
  check_no_faults(*device);
}

TEST_CASE("who comes back to a scene is offered what was left there, in true words") {
  const auto device = make_null_device();
  FileRig rig(*device);
  rig.delete_crate();
  rig.app->open("second");
  rig.play("wait 6");
  CHECK_FALSE(rig.app->ui().find("question.take_up"));
  rig.app->open(rig.file.string());
  rig.play("wait 6");
  REQUIRE(rig.app->ui().find("question.take_up"));
  rig.play("click question.take_up\nwait 6");
  CHECK(rig.app->session().world().find_body("crate").is_null());
  // Taken back as a whole.
  rig.play("key Ctrl+Z\nwait 6");
  CHECK_FALSE(rig.app->session().world().find_body("crate").is_null());
  CHECK_FALSE(rig.app->ui().find("question.take_up"));
  check_no_faults(*device);
}

TEST_CASE("opened anew a scene is looked at as before: camera, selection and curves") {
  const auto device = make_null_device();
  FileRig rig(*device);
  const std::string text =
      replaced(replaced(std::string(two_bodies), "[0, 0.5, 0]", "[0, 5, 0]"),
               "\"target\": [1, 1, 0]", "\"target\": [1, 1, 0], \"follow\": \"crate\"");
  write(rig.file, text);
  rig.play("wait 60\nkey Shift+.\nkey Shift+.\nkey Shift+.\nwait 3\nclick body:crate\nwait 3");
  World& world = rig.app->session().world();
  REQUIRE(rig.app->selected() == world.find_body("crate"));
  rig.app->ask(AddCurve{quantities_of(*rig.app->view().to, rig.app->selected())[1]});
  rig.play("wait 60");
  const Vec3 eye = rig.app->camera().camera().eye;
  const uint64_t tick = rig.tick();
  CHECK(eye.y() < 1.9);  // has gone along
  write(rig.file, replaced(text, "[3, 0.5, 0]", "[2, 0.5, 0]"));
  rig.play("wait 60");
  REQUIRE(says(rig, "opened anew"));
  CHECK(rig.tick() == tick);
  CHECK((rig.app->camera().camera().eye - eye).norm() < 1e-6);
  World& now = rig.app->session().world();
  CHECK(rig.app->selected() == now.find_body("crate"));
  REQUIRE(rig.app->measures().series().size() == 1);
  CHECK(rig.app->measures().series()[0].quantity.name == "crate: height");
  CHECK(rig.app->measures().series()[0].quantity.read(*rig.app->view().to) ==
        now.body(now.find_body("crate"))->pose.x.y());
  check_no_faults(*device);
}

TEST_CASE("a file that was deleted is missed, and saving writes it anew") {
  const auto device = make_null_device();
  FileRig rig(*device);
  std::filesystem::remove(rig.file);
  rig.play("wait 120");
  CHECK(says(rig, "The scene's file is gone"));
  rig.app->ui_state().toast(ToastKind::error, "'my_scene.json' cannot be opened");
  rig.play("key Ctrl+S\nwait 3\nclick save.file\nwait 2\nkey Enter\nwait 60");
  CHECK(std::filesystem::exists(rig.file));
  CHECK_FALSE(says(rig, "cannot be opened"));
  check_no_faults(*device);
}

TEST_CASE("who quits twice means it, and kept work can be thrown away") {
  const auto device = make_null_device();
  FileRig rig(*device);
  rig.delete_crate();
  rig.play("wait 80\nkey Ctrl+Q\nwait 3\nkey Esc\nwait 3");
  CHECK_FALSE(rig.app->quit_requested());
  rig.play("key Ctrl+Q\nwait 3\nkey Ctrl+Q\nwait 2");
  CHECK(rig.app->quit_requested());
  rig.open();
  rig.play("click question.throw_away\nwait 3");
  CHECK(std::filesystem::is_empty(rig.unsaved()));
  CHECK_FALSE(rig.app->session().world().find_body("crate").is_null());
  check_no_faults(*device);
}

TEST_CASE(
    "a second new scene leaves the first one's unsaved work alone, and either is gone on with") {
  Laboratory b;
  b.play("key Ctrl+N\nwait 3");
  const auto first = b.rig.app->session().world().state_hash();
  REQUIRE_FALSE(b.rig.app->ui().find("question.later"));
  b.play("click build.sphere\nwait 2\nclick " + b.at({0, 0, 0}) + "\nwait 3\nkey Esc\nwait 2");
  const uint64_t with_ball = b.hash();
  REQUIRE(with_ball != first);
  // At once: what was done last has not been looked at yet.
  b.play("key Ctrl+N\nwait 3");
  CHECK(b.world().find_body("sphere").is_null());
  REQUIRE(b.rig.app->ui().find("question.later"));
  REQUIRE(b.rig.app->ui().find("question.take_up_untitled"));
  b.play("click question.later\nwait 3");
  b.play("click build.box\nwait 2\nclick " + b.at({0, 0, 0}) + "\nwait 3\nkey Esc\nwait 90");
  b.play("key Ctrl+N\nwait 3");
  REQUIRE(b.rig.app->ui().find("question.take_up_untitled_2"));
  b.play("click question.take_up_untitled\nwait 3");
  CHECK_FALSE(b.world().find_body("sphere").is_null());
  CHECK(b.world().find_body("box").is_null());
  CHECK(b.hash() == with_ball);
  // Saved it is kept there no longer; the other one is.
  const std::string name = (b.rig.folder.path() / "ball.json").string();
  b.play("key Ctrl+S\nwait 3\nclick save.file\nwait 2\nkey Ctrl+A\ntext " + name +
         "\nwait 2\nclick save.write\nwait 3");
  REQUIRE(std::filesystem::exists(name));
  b.play("key Ctrl+N\nwait 3");
  CHECK_FALSE(b.rig.app->ui().find("question.take_up_untitled"));
  CHECK(b.rig.app->ui().find("question.take_up_untitled_2"));
  check_no_faults(*b.device);
}

TEST_CASE("an undo step that was done just now keeps the name of its scene, and is asked about") {
  Laboratory b;
  b.play("key Ctrl+N\nwait 3\nclick build.sphere\nclick " + b.at({0, 0, 0}) + "\nkey Ctrl+Q");
  CHECK_FALSE(b.rig.app->quit_requested());
  REQUIRE_FALSE(b.world().find_body("sphere").is_null());
  b.play("click question.stay\nwait 2\nclick build.box\nclick " + b.at({1.5, 0, 0}) +
         "\nkey Ctrl+N\nwait 3");
  CHECK(b.world().find_body("box").is_null());
  REQUIRE(b.rig.app->ui().find("question.take_up_untitled"));
  b.play("click question.take_up_untitled\nwait 3");
  CHECK_FALSE(b.world().find_body("sphere").is_null());
  CHECK_FALSE(b.world().find_body("box").is_null());
  check_no_faults(*b.device);
}

TEST_CASE("a save that fails keeps the panel, and goes to another name afterwards") {
  Laboratory b;
  b.play("click build.sphere\nwait 2\nclick " + b.at({2, 0, 0}) +
         "\nwait 3\nkey Esc\nwait 2\nkey Ctrl+S\nwait 3");
  // A folder cannot be where a file already is.
  const auto in_the_way = b.rig.folder.path() / "in_the_way";
  REQUIRE(write_file(in_the_way, std::string_view("a file")).ok());
  const std::string impossible = (in_the_way / "scene.json").string();
  b.play("click save.file\nwait 2\nkey Ctrl+A\ntext " + impossible +
         "\nwait 2\nclick save.write\nwait 3");
  const UiState& ui = b.rig.app->ui_state();
  REQUIRE(ui.shows(PanelId::save));
  CHECK(ui.save_fault.find("in_the_way") != std::string::npos);
  CHECK(ui.save_file == impossible);
  const std::string possible = (b.rig.folder.path() / "possible.json").string();
  b.play("click save.file\nwait 2\nkey Ctrl+A\ntext " + possible +
         "\nwait 2\nclick save.write\nwait 3");
  CHECK_FALSE(ui.shows(PanelId::save));
  CHECK(ui.save_fault.empty());
  CHECK(read_file(possible)->find("sphere") != std::string::npos);
  check_no_faults(*b.device);
}

TEST_CASE("what would not open again is not saved, and says why") {
  Laboratory b;
  const auto mesh = b.rig.folder.path() / "wedge.obj";
  const std::string wedge =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  REQUIRE(write_file(mesh, std::string_view(wedge)).ok());
  const auto file = (b.rig.folder.path() / "wedges.json").string();
  REQUIRE(write_file(file, std::string_view(
                               R"({"tumble_scene": 1, "meshes": {"wedge": "wedge.obj"}, "bodies": {
    "ground": {"type": "static", "shape": {"type": "half_space"}},
    "wedge": {"shape": {"type": "mesh", "mesh": "wedge"}, "position": [0, 2, 0]}},
    "cameras": {"main": {"position": [0, 2.5, 9], "target": [0, 1.5, 0]}}})"))
              .ok());
  b.rig.app->open(file);
  b.play("wait 3");
  REQUIRE_FALSE(b.world().find_body("wedge").is_null());
  const std::string before = *read_file(file);
  b.play("click build.sphere\nwait 2\nclick " + b.at({2, 0, 0}) +
         "\nwait 3\nkey Esc\nwait 2\nkey Ctrl+S\nwait 3");
  REQUIRE(b.rig.app->ui().find("save.write"));
  // Elsewhere it would not find its mesh.
  const auto other = b.rig.folder.path() / "elsewhere";
  std::filesystem::create_directories(other);
  b.play("click save.file\nwait 2\nkey Ctrl+A\ntext " + (other / "wedges.json").string() +
         "\nwait 2\nclick save.write\nwait 3");
  // The panel stays, with the reason and what was typed.
  const UiState& ui = b.rig.app->ui_state();
  CHECK(ui.save_fault.find("would not open again") != std::string::npos);
  CHECK(ui.shows(PanelId::save));
  CHECK(ui.save_file == (other / "wedges.json").string());
  CHECK(b.rig.app->ui().find("save.fault"));
  CHECK_FALSE(std::filesystem::exists(other / "wedges.json"));
  b.play("key Esc\nwait 2");
  CHECK_FALSE(ui.shows(PanelId::save));
  std::filesystem::remove(mesh);
  b.play("key Ctrl+S\nwait 3");
  b.play("key Ctrl+S\nwait 3");
  CHECK_FALSE(ui.save_fault.empty());
  CHECK(ui.shows(PanelId::save));
  CHECK(*read_file(file) == before);
  // It goes where its mesh is, though.
  REQUIRE(write_file(other / "wedge.obj", std::string_view(wedge)).ok());
  b.play("key Ctrl+S\nwait 3\nclick save.file\nwait 2\nkey Ctrl+A\ntext " +
         (other / "copy.json").string() + "\nwait 2\nclick save.write\nwait 3");
  CHECK(std::filesystem::exists(other / "copy.json"));
  CHECK(*read_file(file) == before);
  std::filesystem::remove(other / "wedge.obj");
  b.play("key Ctrl+S\nwait 3\nclick save.file\nwait 2\nkey Ctrl+A\ntext " + file + "\nwait 2");
  REQUIRE(write_file(mesh, std::string_view(wedge)).ok());
  b.play("click save.write\nwait 3");
  CHECK(*read_file(file) != before);
  check_no_faults(*b.device);
}

TEST_CASE("saving under another name warns of a file that is there, and wants a name") {
  Laboratory b;
  const auto there = b.rig.folder.path() / "there.json";
  REQUIRE(write_file(there, std::string_view("{}")).ok());
  b.play("click build.sphere\nwait 2\nclick " + b.at({2, 0, 0}) +
         "\nwait 3\nkey Esc\nwait 2\nkey Ctrl+S\nwait 3");
  const UiState& ui = b.rig.app->ui_state();
  REQUIRE(ui.save_file == b.file);
  CHECK_FALSE(b.rig.app->ui().find("save.warning"));
  b.play("click save.file\nwait 2\nkey Ctrl+A\ntext " + there.string() + "\nwait 3");
  CHECK(b.rig.app->ui().find("save.warning"));
  b.play("text x\nwait 3");
  CHECK_FALSE(b.rig.app->ui().find("save.warning"));
  // A field that was emptied stays so.
  const std::string before = *read_file(b.file);
  b.play("key Ctrl+A\nwait 1\nkey Backspace\nwait 2\nclick save.write\nwait 3");
  CHECK(ui.save_file.empty());
  CHECK(ui.save_fault.find("name is missing") != std::string::npos);
  CHECK(ui.shows(PanelId::save));
  CHECK(*read_file(b.file) == before);
  CHECK(*read_file(there) == "{}");
  check_no_faults(*b.device);
}
