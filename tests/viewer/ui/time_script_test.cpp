// Bookmarks, loops, flights, rulers and plots in the window. References: ticks counted by hand,
// plane geometry, and the world itself.
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("keys and pointer set, name, reach and delete bookmarks, and they outlive the window") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("wait 12\nkey Space\nwait 2\nkey Ctrl+B\nwait 2");
  const uint64_t first = rig.tick();
  rig.play("key Shift+.\nkey Shift+.\nwait 2\nclick timeline.bookmark\nwait 2");
  const uint64_t second = rig.tick();
  CHECK(second == first + 20);
  const auto marks = [&]() -> const TimeMarks& { return rig.app->marks().time; };
  REQUIRE(marks().bookmarks.size() == 2);
  rig.play("key Ctrl+[\nwait 3");
  CHECK(rig.tick() == first);
  rig.play("key Ctrl+]\nwait 3");
  CHECK(rig.tick() == second);
  rig.play("click timeline.mark.0\nwait 3");
  CHECK(rig.tick() == first);
  rig.play(
      "key Shift+B\nwait 4\nclick bookmarks.0.name\nwait 2\nkey Ctrl+A\ntext touch\nkey Enter\n"
      "wait 4\nclick bookmarks.1.go\nwait 3");
  CHECK(rig.tick() == second);
  CHECK(marks().bookmarks[0].name == "touch");
  const auto file = rig.folder.path() / "config/bookmarks.json";
  const auto text = read_file(file);
  REQUIRE(text.ok());
  CHECK(text->find("\"touch\"") != std::string::npos);
  // Another scene has none; this one has its own again.
  rig.play("key ]\nwait 3");
  CHECK(rig.app->scene_name() == "second");
  CHECK(marks().bookmarks.empty());
  rig.play("key [\nwait 3");
  REQUIRE(marks().bookmarks.size() == 2);
  CHECK(marks().bookmarks[0] == Bookmark{first, "touch"});
  rig.play("wait 3\nclick bookmarks.0.close\nwait 3");
  REQUIRE(marks().bookmarks.size() == 1);
  CHECK(marks().bookmarks[0].tick == second);
  check_no_faults(*device);
}

TEST_CASE("a span is marked on the line of time and played over and over") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play(
      "wait 20\nkey Space\nwait 2\nkey Ctrl+B\nkey Shift+.\nwait 2\nkey Ctrl+B\nkey .\nkey .\n"
      "key Ctrl+[\nwait 3\nkey Ctrl+L\nwait 1");
  const TimeMarks& marks = rig.app->marks().time;
  REQUIRE(marks.span);
  CHECK(marks.looping);
  const TickSpan span = *marks.span;
  uint64_t least = ~uint64_t{0}, most = 0, returns = 0, before = rig.tick();
  for (int i = 0; i < 120; ++i) {
    rig.frame();
    least = std::min(least, rig.tick());
    most = std::max(most, rig.tick());
    returns += rig.tick() < before;
    before = rig.tick();
  }
  CHECK(returns >= 3);
  CHECK(least >= span.from);
  CHECK(most <= span.to + 1);
  CHECK_FALSE(rig.app->session().paused());
  rig.play("key Ctrl+L\nwait 60");
  CHECK(rig.tick() > span.to + 20);
  check_no_faults(*device);
}

TEST_CASE("what is changed while a span is looped stays, and the loop ends") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("wait 30\nkey Ctrl+L\nwait 1");
  const TimeMarks& marks = rig.app->marks().time;
  REQUIRE(marks.looping);
  WorldSettings wanted = rig.app->settings();
  wanted.gravity = Vec3(0, -3, 0);
  rig.app->ask(ChangeSettings{wanted});
  CHECK_FALSE(marks.looping);
  CHECK(says(rig, "loop is switched off"));
  const uint64_t to = marks.span->to;
  rig.play("wait 60");
  CHECK(rig.tick() > to);
  CHECK(rig.app->settings().gravity.now() == wanted.gravity.now());
  check_no_faults(*device);
}

TEST_CASE("a recording is not looped, and says so") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 10\nkey F9\nwait 3");
  REQUIRE(rig.app->recording());
  rig.app->perform(Action::toggle_loop);
  CHECK_FALSE(rig.app->marks().time.looping);
  CHECK(says(rig, "No loop while recording"));
  const uint64_t tick = rig.tick();
  rig.app->ask(GoToMoment{0});
  rig.play("wait 3");
  CHECK(rig.app->recording());
  CHECK(rig.tick() >= tick);
  rig.play("key F9\nwait 2");
  check_no_faults(*device);
}

TEST_CASE("points of an angle that is given up do not hinder the distance after it") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play(
      "key Space\nwait 2\nkey U\nwait 3\nclick ruler.angle\nwait 2\nclick body:box\nwait 2\n"
      "click body:ball\nwait 2\nclick ruler.distance\nwait 2\nclick body:box\nwait 2\n"
      "click body:ball\nwait 2");
  REQUIRE(rig.app->ruler().view().readings.size() == 1);
  CHECK_FALSE(rig.app->ruler().view().readings[0].angle);
  check_no_faults(*device);
}

TEST_CASE("a ruler goes on measuring while its body falls, and waits for it") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("key Space\nwait 2\nkey U\nwait 3\nclick body:box\nwait 2\nclick body:ball\nwait 2");
  const auto& readings = rig.app->ruler().view().readings;
  REQUIRE(readings.size() == 1);
  CHECK(rig.app->selected().is_null());  // the click was the ruler's
  const double before = readings[0].value;
  const Vec3 apart = readings[0].apart;
  CHECK(before == doctest::Approx(apart.norm()));
  const double height = rig.height("ball");
  rig.play("key Shift+.\nkey Shift+.\nwait 2");
  const double fallen = height - rig.height("ball");
  REQUIRE(fallen > 0.3);
  CHECK(readings[0].value == doctest::Approx((apart - Vec3(0, fallen, 0)).norm()).epsilon(1e-6));
  rig.play(
      "click ruler.angle\nwait 2\nclick body:ball\nwait 2\nclick body:box\nwait 2\n"
      "click body:ball\nwait 2");
  REQUIRE(readings.size() == 2);
  CHECK(readings[1].angle);
  CHECK(readings[1].value < 1e-6);  // there and back
  rig.play("click ruler.0.plot\nwait 3");
  REQUIRE(rig.app->measures().series().size() == 1);
  CHECK(double(rig.app->measures().series()[0].values.back()) ==
        doctest::Approx(readings[0].value));
  rig.play("key Esc\nwait 2\nclick body:ball\nkey Del\nkey .\nwait 3");
  REQUIRE(readings.size() == 2);
  CHECK_FALSE(readings[0].there);
  CHECK_FALSE(readings[1].there);
  rig.play("key Ctrl+Z\nwait 3");
  REQUIRE(readings.size() == 2);
  CHECK(readings[0].there);
  rig.play("click ruler.1.close\nwait 2\nclick ruler.0.close\nwait 2");
  CHECK(readings.empty());
  check_no_faults(*device);
}

TEST_CASE("keys of a camera are recorded, flown along and forgotten") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("key Space\nwait 2\nkey Y\nwait 4\n");
  const Vec3 from = rig.app->camera().camera().eye;
  rig.play("key Shift+.\nkey Shift+.\nwait 2\ndrag 640,200 80 0\nwait 40\nkey Y\nwait 3");
  const Vec3 to = rig.app->camera().camera().eye;
  REQUIRE((to - from).norm() > 0.1);
  REQUIRE(rig.app->marks().flight.size() == 2);
  rig.play("key Shift+Y\nwait 2\nclick bookmarks.key.0.go\nwait 3");
  CHECK((rig.app->camera().camera().eye - from).norm() < 1e-9);
  rig.play("key Shift+.\nwait 3");
  const Vec3 between = rig.app->camera().camera().eye;
  // At rest at both ends: half way at half time. Times of keys are kept to a microsecond.
  CHECK((between - 0.5 * (from + to)).norm() < 1e-5);
  rig.play("key Shift+.\nwait 3");
  CHECK((rig.app->camera().camera().eye - to).norm() < 1e-5);
  rig.play("click bookmarks.key.0.close\nwait 2");
  CHECK(rig.app->marks().flight.size() == 1);
  check_no_faults(*device);
}

TEST_CASE("a key follows a body, and the flight with it") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("key Space\nwait 2\nkey Y\nwait 4");
  const Vec3 eye = rig.app->camera().camera().eye;
  const double begun = rig.height("ball");
  rig.play("click bookmarks.key.0.follow\nwait 3\nclick bookmarks.key.0.ball\nwait 3");
  REQUIRE(rig.app->marks().flight.size() == 1);
  CHECK(rig.app->marks().flight[0].follow == "ball");
  CHECK(rig.app->marks().flight[0].follow_x.y() == begun);
  rig.play("key Shift+Y\nwait 2\nkey Shift+.\nkey Shift+.\nwait 3");
  const double fallen = begun - rig.height("ball");
  REQUIRE(fallen > 0.1);
  CHECK((rig.app->camera().camera().eye - (eye - Vec3(0, fallen, 0))).norm() < 1e-9);
  // Elsewhere than at its moment a key cannot be tied to a body.
  rig.app->ask(FollowFromKey{0, "box"});
  CHECK(says(rig, "go there first"));
  CHECK(rig.app->marks().flight[0].follow == "ball");
  rig.app->ask(FollowFromKey{0, ""});
  CHECK(rig.app->marks().flight[0].follow.empty());
  check_no_faults(*device);
}

TEST_CASE("plots stand apart, together or against each other, go to moments, and are written") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 900, 1};
  rig.play(
      "key Space\nwait 2\nclick body:ball\nkey P\nwait 3\nclick measure.choose\nwait 3\n"
      "click measure.ball:_height\nwait 3\nclick measure.choose\nwait 3\n"
      "click measure.ball:_velocity_y\nwait 3");
  for (int k = 0; k < 6; ++k) rig.play("key Shift+.\nwait 2");
  REQUIRE(rig.app->measures().series().size() == 2);
  const uint64_t last = rig.tick();
  rig.play("click measure.together\nwait 3\nclick measure.all\nwait 3");
  // The middle of the plot, with its axes at the right, is before the last of the samples.
  CHECK(rig.tick() < last);
  CHECK(rig.tick() > last / 3);
  rig.play(
      "click measure.phase\nwait 3\nclick measure.across\nwait 3\nclick measure.across.1\nwait 3");
  CHECK(rig.app->ui_state().plot.across == 1);
  CHECK(rig.app->ui().find("measure.phase_plot"));
  rig.play("click measure.png\nwait 3");
  REQUIRE_FALSE(rig.app->captured().empty());
  CHECK(rig.app->captured().back().filename().string().find("plot") != std::string::npos);
  check_no_faults(*device);
}

TEST_CASE("who flies goes on flying when a key is changed, and is told of a flight that is over") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  const auto eye = [&] { return rig.app->camera().camera().eye; };
  rig.play("key Space\nwait 2\nkey Y\nwait 4\nkey Shift+.\nwait 2\ndrag 640,200 80 0\nwait 40");
  const Vec3 there = eye();
  rig.play("key Y\nwait 3\nkey Shift+.\nwait 2\ndrag 640,200 80 0\nwait 40\nkey Y\nwait 3");
  const Vec3 last = eye();
  REQUIRE(rig.app->marks().flight.size() == 3);
  CHECK_FALSE(says(rig, "come to its end"));
  rig.play("key Shift+Y\nwait 2");
  CHECK(says(rig, "come to its end"));
  CHECK(says(rig, fmt::format("keys are at {:.2f} s to {:.2f} s", rig.app->marks().flight[0].time,
                              rig.app->marks().flight[2].time)));
  rig.play("click bookmarks.key.0.go\nwait 3");
  rig.play("click bookmarks.key.0.follow\nwait 3\nclick bookmarks.key.0.box\nwait 3");
  REQUIRE(rig.app->marks().flight[0].follow == "box");
  rig.play("key Shift+.\nwait 3");
  CHECK((eye() - there).norm() < 1e-5);
  rig.play("click bookmarks.key.1.close\nwait 3\nkey Shift+.\nwait 3");
  CHECK((eye() - last).norm() < 1e-5);
  check_no_faults(*device);
}

TEST_CASE("times of bookmarks and keys stand level with what is beside them") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("key Space\nwait 2\nkey Y\nwait 2\nkey Ctrl+B\nwait 4");
  const auto middle = [&](const char* name) {
    const auto rect = rig.app->ui().find(name);
    REQUIRE(rect);
    return rect->y + 0.5f * rect->height;
  };
  CHECK(middle("bookmarks.0.go") == middle("bookmarks.0.name"));
  CHECK(middle("bookmarks.key.0.go") == middle("bookmarks.key.0.follow"));
}

TEST_CASE("bookmarks and keys of the flight are taken back in the order of all that was done") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  const auto marks = [&]() -> const SceneMarks& { return rig.app->marks(); };
  rig.play("key Space\nwait 5\nkey Ctrl+B\nwait 2");  // at tick 0 or soon after
  const uint64_t tick = rig.tick();
  REQUIRE(marks().time.bookmarks.size() == 1);
  rig.play("click body:box\nwait 3\nkey Del\nwait 3");
  REQUIRE(rig.height("box") == -1);
  rig.play("key Y\nwait 4");
  REQUIRE(marks().flight.size() == 1);
  rig.play(
      "click bookmarks.0.name\nwait 2\nkey Ctrl+A\n"
      "text touch\nkey Enter\nwait 3");
  REQUIRE(marks().time.bookmarks[0].name == "touch");

  rig.play("key Ctrl+Z\nwait 3");  // the name, whole
  CHECK(says(rig, "Taken back: Change a bookmark"));
  CHECK(marks().time.bookmarks[0].name == "mark 1");
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(marks().flight.empty());
  CHECK(rig.height("box") == -1);
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(rig.height("box") > 0);
  CHECK(marks().time.bookmarks.size() == 1);
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(marks().time.bookmarks.empty());
  CHECK(rig.tick() == tick);
  // And done again in the same order.
  rig.play("key Ctrl+Shift+Z\nwait 3");
  CHECK(marks().time.bookmarks.size() == 1);
  rig.play("key Ctrl+Shift+Z\nwait 3\nkey Ctrl+Shift+Z\nwait 3\nkey Ctrl+Shift+Z\nwait 3");
  CHECK(rig.height("box") == -1);
  CHECK(marks().flight.size() == 1);
  CHECK(marks().time.bookmarks[0].name == "touch");
  // Which span is looped is no undo step.
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(marks().time.bookmarks[0].name == "mark 1");
  check_no_faults(*device);
}

TEST_CASE("who clicks twice with the ruler out means one point, and stays where they look from") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("key Space\nwait 3\nkey U\nwait 3");
  const Vec3 target = rig.app->camera().camera().target;
  rig.play("double_click body:box\nwait 10");
  CHECK(rig.app->ruler().view().readings.empty());
  CHECK(rig.app->ruler().view().picked == 1);
  CHECK(rig.app->camera().camera().target == target);
  rig.play("wait 40\nclick body:ball\nwait 3");
  REQUIRE(rig.app->ruler().view().readings.size() == 1);
  CHECK(rig.app->ruler().view().readings[0].value > 1);
  // Without it a double click looks at what was clicked, as ever.
  rig.play("key Esc\nwait 40\ndouble_click body:ball\nwait 40");
  CHECK(rig.app->camera().camera().target != target);
  check_no_faults(*device);
}
