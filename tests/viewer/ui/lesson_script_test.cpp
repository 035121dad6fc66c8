// Lessons beside the picture, by pointer and keys, and what their questions take for right.
// References: free fall in closed form; the worlds of the shipped lessons against the numbers that
// their authors computed.
#include "engine/scene/catalogue.hpp"
#include "tests/support/why_not.hpp"
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/app/scenes/lesson_check.hpp"

#include <algorithm>
#include <fstream>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

std::string lesson_scene(const Rig& rig) {
  const std::string file = (rig.folder.path() / "falling.json").string();
  std::ofstream(file) << R"({"tumble_scene": 1,
    "parameters": {"height": {"value": 5, "min": 1, "max": 9, "doc": "of the ball [m]"}},
    "settings": {"stepper": "event"},
    "bodies": {"ball": {"position": [0, "$height", 0], "shape": {"type": "sphere", "radius": 0.5}}},
    "cameras": {"main": {}, "near": {"position": [0, 5, 3], "target": [0, 5, 0]}},
    "lesson": {"about": "falling", "steps": [
      {"title": "One", "text": ["First.", "Second."], "question":
        {"ask": "One and a half?", "answer": 1.5, "tolerance": 0.01, "unit": "m", "hint": "3/2", "why": "So it is."}},
      {"title": "Two", "text": ["Look."], "camera": "near", "overlays": ["aabbs"], "plot": ["bodies.ball.speed"],
       "restart": true, "question":
        {"ask": "How fast at half a second?", "quantity": "bodies.ball.speed", "at": 0.5, "tolerance": 0.01}},
      {"title": "Three", "text": ["Higher."], "choose": ["parameters.height=7"], "question":
        {"ask": "How high now?", "quantity": "bodies.ball.position.y", "tolerance": 0.01}},
      {"title": "Four", "text": ["Done."]}]}})";
  return file;
}

AnswerVerdict verdict(const Rig& rig, size_t page) {
  return rig.app->lesson()->steps[page].question->verdict;
}

/// Types an answer into the field of the page.
void give_answer(Rig& rig, const std::string& text) {
  rig.play("click lesson.answer\nwait 2\nkey Ctrl+A\nwait 1\ntext " + text +
           "\nwait 1\nkey Enter\nwait 3");
}

}  // namespace

TEST_CASE("pages turn by buttons, keys and dots, and bring camera, overlays and curves") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::lesson));
  rig.app->open(lesson_scene(rig));
  rig.play("wait 3");
  REQUIRE(rig.app->ui_state().shows(PanelId::lesson));
  CHECK(rig.app->lesson()->step == 0);
  CHECK(rig.app->ui().find("bar.lesson"));
  rig.play("click lesson.next\nwait 30");
  CHECK(rig.app->lesson()->step == 1);
  CHECK(rig.app->session().paused());
  CHECK(rig.tick() == 0);
  CHECK(rig.app->ui_state().overlays.aabbs);
  CHECK(rig.app->camera().camera().eye.isApprox(Vec3(0, 5, 3), 1e-3));
  REQUIRE(rig.app->measures().series().size() == 1);
  CHECK(rig.app->measures().series()[0].quantity.unit == "m/s");
  rig.play("key PageDown\nwait 3");
  CHECK(rig.app->lesson()->step == 2);
  CHECK_FALSE(rig.app->ui_state().overlays.aabbs);
  rig.play("key PageUp\nkey PageUp\nwait 3");
  CHECK(rig.app->lesson()->step == 0);
  rig.play("key PageUp\nclick lesson.back\nwait 3");
  CHECK(rig.app->lesson()->step == 0);
  rig.play("click lesson.page.3\nwait 3");
  CHECK(rig.app->lesson()->step == 3);
  rig.play("key PageDown\nclick lesson.next\nwait 3");
  CHECK(rig.app->lesson()->step == 3);
  rig.play("key L\nwait 3");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::lesson));
  // Keys that are typed as an answer are no commands, and a scene without lesson has none.
  rig.play("key L\nkey PageUp\nkey PageUp\nwait 3");
  REQUIRE(rig.app->ui_state().overlays.aabbs);
  rig.app->open("second");
  rig.play("wait 3\nkey L\nwait 3");
  CHECK_FALSE(rig.app->ui_state().overlays.aabbs);
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::lesson));
  CHECK_FALSE(rig.app->ui().find("bar.lesson"));
  check_no_faults(*device);
}

TEST_CASE("answers are judged by the lesson's number, or by the world at its moment") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.app->open(lesson_scene(rig));
  rig.play("wait 3\nkey Space\nwait 2");
  give_answer(rig, "2.5");
  CHECK(verdict(rig, 0) == AnswerVerdict::wrong);
  CHECK_FALSE(rig.app->ui_state().lesson_hint);
  rig.play("click lesson.hint\nwait 2");
  CHECK(rig.app->ui_state().lesson_hint);
  give_answer(rig, "many");
  CHECK(verdict(rig, 0) == AnswerVerdict::unclear);
  give_answer(rig, "1,5m");
  CHECK(verdict(rig, 0) == AnswerVerdict::right);
  // What was said before it is decided waits for the world.
  rig.play("key PageDown\nwait 3");
  give_answer(rig, "4.905");
  CHECK(verdict(rig, 1) == AnswerVerdict::waiting);
  rig.play("key Space\nwait 40\nkey Space\nwait 2");
  CHECK(verdict(rig, 1) == AnswerVerdict::right);
  CHECK(*rig.app->lesson()->steps[1].question->measured == doctest::Approx(4.905).epsilon(1e-3));
  // A choice opens the scene anew and leaves one on the page, with all that was answered.
  rig.play("key PageDown\nwait 3\nclick lesson.choose\nwait 5");
  CHECK(rig.wished == std::vector<std::string>{"parameters.height=7"});
  CHECK(rig.app->lesson()->step == 2);
  CHECK(rig.app->lesson()->steps[2].chosen);
  CHECK(verdict(rig, 0) == AnswerVerdict::right);
  CHECK(verdict(rig, 1) == AnswerVerdict::right);
  rig.app->session().set_paused(true);
  rig.app->ask(SeekTick{0});
  rig.play("wait 3");
  give_answer(rig, "5");
  CHECK(verdict(rig, 2) == AnswerVerdict::wrong);
  give_answer(rig, "7");
  CHECK(verdict(rig, 2) == AnswerVerdict::right);
  // Who goes back finds each answer beside its verdict.
  rig.play("key PageUp\nwait 2");
  CHECK(rig.app->ui_state().lesson_typed == "4.905");
  rig.play("key PageUp\nwait 2");
  CHECK(rig.app->ui_state().lesson_typed == "1,5m");
  rig.play("key PageDown\nwait 2\nkey PageDown\nwait 2\nkey PageDown\nwait 2");
  CHECK(rig.app->lesson()->questions() == 3);
  CHECK(rig.app->lesson()->answered() == 3);
  check_no_faults(*device);
}

TEST_CASE("numbers are read as people type them") {
  CHECK(*typed_number(" 1 000.5 ", "") == 1000.5);
  CHECK(*typed_number("0,25 m", "m") == 0.25);
  CHECK(*typed_number("+3e-2 kg m²", "kg m²") == 0.03);
  CHECK(*typed_number("-1.5", "rad/s") == -1.5);
  for (const char* no : {"", "m", "1.2.3", "1,000,000", "nan", "inf", "4 kg", "0x10", "--1"})
    CHECK_FALSE(typed_number(no, "m"));
}

TEST_CASE("the world gives the answers of every lesson that comes with Tumble") {
  size_t lessons = 0, decided = 0;
  for (const CatalogueEntry& entry : scene_catalogue()) {
    if (!entry.name.starts_with("lesson_")) continue;
    CAPTURE(entry.name);
    ++lessons;
    SceneRequest request;
    request.scene = entry.name;
    request.threads = 1;
    const auto checks = check_lesson(request);
    REQUIRE_MESSAGE(checks.ok(), test::why_not(checks));
    CHECK(!checks->empty());
    for (const SceneLesson::Check& c : *checks) {
      INFO("page ", c.step + 1, ": ", c.ask, " answer ", c.answer.value_or(-1), " measured ",
           c.measured.value_or(-1));
      CHECK(c.holds());
      ++decided;
    }
  }
  CHECK(lessons == 14);
  CHECK(decided >= 25);
}

TEST_CASE("a world that behaves otherwise is found out") {
  SceneRequest request;
  request.scene = "lesson_04_rigid_bodies";
  request.threads = 1;
  request.overrides = {"materials.rough.friction=0.05"};
  const auto checks = check_lesson(request);
  REQUIRE(checks.ok());
  CHECK(std::ranges::count_if(*checks, [](const auto& c) { return !c.holds(); }) == 1);
}

TEST_CASE("curves of a page outlive its choice and pages that plot nothing") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.app->open(lesson_scene(rig));
  const auto& series = rig.app->measures().series();
  rig.play("wait 3\nclick lesson.page.1\nwait 3");
  REQUIRE(series.size() == 1);
  rig.app->ask(AddNamedCurve{"bodies.ball.position.y"});
  rig.play("click lesson.page.2\nwait 3");
  CHECK(series.size() == 2);
  rig.play("click lesson.choose\nwait 5");
  REQUIRE(series.size() == 2);  // that of the page, and the person's own
  CHECK(series[0].quantity.name == "bodies.ball.speed");
  CHECK(series[1].quantity.name == "bodies.ball.position.y");
  CHECK(rig.app->ui_state().shows(PanelId::measure));
  check_no_faults(*device);
}

TEST_CASE("the buttons that turn the pages stay in sight in a small picture beside a plot") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {800, 600, 1};
  rig.app->open(lesson_scene(rig));
  rig.play("wait 3\nclick lesson.page.1\nwait 3");
  for (const char* curve : {"bodies.ball.position.y", "bodies.ball.speed", "energy.total"})
    rig.app->ask(AddNamedCurve{curve});
  rig.play("wait 5");
  REQUIRE(rig.app->ui_state().shows(PanelId::measure));
  const auto inside = [&](const char* widget) {
    const auto panel = rig.app->ui().find("panel.lesson"), button = rig.app->ui().find(widget);
    REQUIRE_MESSAGE((panel && button), widget);
    CHECK_MESSAGE(button->y >= panel->y, widget);
    CHECK_MESSAGE(button->y + button->height <= panel->y + panel->height, widget);
  };
  for (size_t page = 1; page < 4; ++page) {
    CAPTURE(page);
    CHECK(rig.app->lesson()->step == page);
    inside("lesson.back");
    inside("lesson.next");
    rig.play("click lesson.next\nwait 20");  // the last one does nothing
  }
  rig.play("click lesson.back\nwait 5");
  CHECK(rig.app->lesson()->step == 2);
  // Where there is room they stand right under the text.
  rig.picture = {1200, 900, 1};
  rig.play("wait 5");
  inside("lesson.next");
  const auto panel = rig.app->ui().find("panel.lesson"), button = rig.app->ui().find("lesson.next");
  CHECK(panel->y + panel->height - button->y - button->height < 40);
  check_no_faults(*device);
}
