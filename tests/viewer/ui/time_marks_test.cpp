// What a person marks in time, the file that keeps it, and angles. References: ticks counted by
// hand, every pair of small ticks, and angles in closed form.
#include "tests/support/temp_folder.hpp"
#include "viewer/app/window/marks_controller.hpp"
#include "viewer/app/window/ruler.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("bookmarks stand by tick, one a tick, and a span never runs backwards") {
  TimeMarks marks;
  for (const uint64_t tick : {30u, 10u, 20u}) marks.toggle(tick);
  REQUIRE(marks.bookmarks.size() == 3);
  CHECK(marks.bookmarks[0].tick == 10);
  CHECK(marks.bookmarks[2].tick == 30);
  CHECK(marks.next(10)->tick == 20);
  CHECK(marks.next(9)->tick == 10);
  CHECK_FALSE(marks.next(30));
  CHECK(marks.previous(30)->tick == 20);
  CHECK_FALSE(marks.previous(10));
  marks.toggle(20);
  CHECK(marks.bookmarks.size() == 2);
  CHECK(marks.span_about(15, 0, 50) == TickSpan{10, 30});
  CHECK(marks.span_about(40, 0, 50) == TickSpan{30, 50});
  CHECK(marks.span_about(10, 0, 50) == TickSpan{0, 10});
  CHECK_FALSE(TimeMarks{}.span_about(0, 0, 0));
  for (uint64_t from = 0; from < 6; ++from)
    for (uint64_t to = 0; to < 6; ++to) {
      marks.span.reset();
      marks.begin_span(from, 5);
      marks.end_span(to, 0);
      CHECK(marks.span->from < marks.span->to);
      marks.begin_span(from, 5);
      CHECK(marks.span->from == from);
      CHECK(marks.span->from < marks.span->to);
    }
}

TEST_CASE("the file of bookmarks gives back what it was given, and leaves other scenes alone") {
  SceneMarks marks;
  marks.time.toggle(90, "he said \"now\"");
  marks.time.span = TickSpan{30, 60};
  CameraKey key;
  key.time = 0.5;
  key.camera.eye = Vec3(1, 2, 3);
  key.camera.target = Vec3(0.1, 0, -4);
  key.follow = "ball";
  key.follow_x = Vec3(0, 4, 0.25);
  marks.flight.push_back(key);
  const auto first = with_marks("", "/a.json", marks, TickClock(1.0 / 60));
  REQUIRE(first.ok());
  // A scene of another tick comes to the same file: the first one's times stay as they were.
  SceneMarks other;
  other.time.toggle(7, "x");
  const auto both = with_marks(*first, "/b.json", other, TickClock(1.0 / 240));
  REQUIRE(both.ok());
  const auto back = read_marks(*both, "/a.json", 1.0 / 60);
  REQUIRE(back.ok());
  CHECK(back->time == marks.time);
  REQUIRE(back->flight.size() == 1);
  CHECK(back->flight[0].time == 0.5);
  CHECK(back->flight[0].camera.eye == key.camera.eye);
  CHECK(back->flight[0].camera.target == key.camera.target);
  CHECK(back->flight[0].follow == "ball");
  CHECK(back->flight[0].follow_x == key.follow_x);
  CHECK(read_marks(*both, "/b.json", 1.0 / 240)->time == other.time);
  // At half the tick the same moment is another one.
  CHECK(read_marks(*both, "/a.json", 1.0 / 120)->time.bookmarks[0].tick == 180);
  CHECK(read_marks(*both, "/c.json", 1.0 / 60)->empty());
  const auto without = with_marks(*both, "/b.json", {}, TickClock(1.0 / 240));
  REQUIRE(without.ok());
  CHECK(*without == *first);
  for (const char* bad :
       {"{", "[]",
        "{\"scenes\": {\"/a.json\": {\"bookmarks\": [{\"time\": -1, "
        "\"name\": \"\"}]}}}",
        "{\"scenes\": {\"/a.json\": {\"flight\": [{\"time\": 1, \"position\": [1, 2, 3], "
        "\"target\": [0, 0, 0], \"fov_deg\": 40, \"follow\": \"ball\"}]}}}",
        "{\"scenes\": {\"/a.json\": {\"flight\": [{\"time\": 1}]}}}"})
    CHECK_FALSE(read_marks(bad, "/a.json", 1.0 / 60).ok());
}

TEST_CASE("keys of a flight at times that no run reaches, or without a direction, are refused") {
  const auto read = [](const std::string& time, const std::string& target) {
    return read_marks("{\"scenes\": {\"/a.json\": {\"flight\": [{\"time\": " + time +
                          ", \"position\": [1, 2, 3], \"target\": " + target +
                          ", \"fov_deg\": 40}]}}}",
                      "/a.json", 1.0 / 60);
  };
  REQUIRE(read("1.5", "[0, 0, 0]").ok());
  CHECK(read("1.5", "[0, 0, 0]")->flight.size() == 1);
  for (const char* time : {"-1", "1e300"}) {
    const auto marks = read(time, "[0, 0, 0]");
    REQUIRE_FALSE(marks.ok());
    CHECK(marks.error().text().find("a time that no run reaches") != std::string::npos);
    CHECK(marks.error().text().find("mend the file, or delete it") != std::string::npos);
  }
  const auto blind = read("1", "[1, 2, 3]");
  REQUIRE_FALSE(blind.ok());
  CHECK(blind.error().text().find("a camera that looks nowhere") != std::string::npos);
}

TEST_CASE("bookmarks that cannot be written are kept back and tried again") {
  const TempFolder folder;
  const auto in_the_way = folder.path() / "config";
  REQUIRE(write_file(in_the_way, std::string_view("a file where a folder should be")).ok());
  MarksController controller(in_the_way / "bookmarks.json");
  REQUIRE(controller.open("/a.json", 1.0 / 60).ok());
  controller.change([](SceneMarks& marks) { marks.time.toggle(30, "here"); });
  CHECK_FALSE(controller.keep().ok());
  CHECK(controller.keep().ok());  // said once
  CHECK_FALSE(controller.keep(true).ok());
  REQUIRE(std::filesystem::remove(in_the_way));
  CHECK(controller.keep(true).ok());
  const auto text = read_file(in_the_way / "bookmarks.json");
  REQUIRE(text.ok());
  CHECK(text->find("\"here\"") != std::string::npos);
}

TEST_CASE("ticks and times belong together though the tick is changed on the way") {
  // Ten ticks of 0.1 s, then ones of 0.05 s: by hand.
  TickClock clock(0.1);
  for (uint64_t tick = 0; tick <= 10; ++tick) clock.see(tick, 0.1 * double(tick), 0.1);
  clock.see(10, 1.0, 0.05);
  clock.see(14, 1.2, 0.05);
  CHECK(clock.time_of(5) == doctest::Approx(0.5));
  CHECK(clock.time_of(10) == doctest::Approx(1.0));
  CHECK(clock.time_of(20) == doctest::Approx(1.5));
  CHECK(clock.tick_at(0.5) == 5);
  CHECK(clock.tick_at(1.1) == 12);
  CHECK(clock.tick_at(-3) == 0);
  SceneMarks marks;
  marks.time.toggle(20, "late");
  const auto text = with_marks("", "/a.json", marks, clock);
  REQUIRE(text.ok());
  CHECK(read_marks(*text, "/a.json", 0.1)->time.bookmarks[0].tick == 15);
  // Back before the change, where ticks are long again.
  clock.see(4, 0.4, 0.1);
  CHECK(clock.time_of(20) == doctest::Approx(2.0));
}

TEST_CASE("an angle is exact for arms that are nearly parallel") {
  for (const double a : {0.0, 1e-12, 1e-5, 1.0, std::numbers::pi - 1e-9, std::numbers::pi}) {
    const double got = angle_between(Vec3(2, 0, 0), 3 * Vec3(std::cos(a), std::sin(a), 0));
    CHECK(got == doctest::Approx(a).epsilon(1e-12));
  }
}
