// Reference: free fall in closed form; the same bits for any number of threads; ticks counted by
// hand.
#include "engine/dynamics/simd/simd_target.hpp"
#include "tests/viewer/cli/program.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;

namespace {

std::string falling() {
  return R"({"tumble_scene": 1, "settings": {"stepper": "event"}, "bodies": {
    "near": {"shape": {"type": "sphere", "radius": 0.1}, "gravity_scale": 0.5},
    "ball": {"shape": {"type": "sphere", "radius": 0.1}, "position": [5, 0, 0]}}})";
}

nlohmann::json answer(const std::vector<std::string>& arguments, int code) {
  std::vector<std::string> all{"verify"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  all.push_back("--json");
  const ProgramRun run = tumble_program(all);
  INFO(run.err);
  REQUIRE(run.code == code);
  return nlohmann::json::parse(run.out);
}

}  // namespace

TEST_CASE("two runs of one scene have the same bits, whatever the threads") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const auto found = answer({scene, "--threads-a", "1", "--threads-b", "3", "--seconds", "1"}, 0);
  CHECK(found["agrees"] == true);
  CHECK(found["moments"] == 61);
  CHECK(found["worst"]["distance"] == 0);
}

TEST_CASE("what differs is named, with the moment and how far it is off") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", falling());
  const std::vector<std::string> line{scene, "--b", "settings.gravity=[0,-5.81,0]", "--seconds",
                                      "1"};
  const auto found = answer(line, 1);
  CHECK(found["first"]["tick_a"] == 1);
  CHECK(found["first"]["what"] == "ball");
  CHECK(found["first"]["distance"].get<double>() == doctest::Approx(0.5 * 4 / 3600.0));
  // 2 t^2 > 0.5 at t > 1/2 s, which is tick 30 itself: the next one is the first beyond.
  auto wide = line;
  wide.insert(wide.end(), {"--tolerance", "0.5000001"});
  CHECK(answer(wide, 1)["first"]["tick_a"] == 31);
  wide.back() = "3";
  CHECK(answer(wide, 0)["worst"]["distance"].get<double>() == doctest::Approx(2.0));
}

TEST_CASE("worlds of different ticks are compared where both have one") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", falling());
  const std::string csv = (folder / "apart.csv").string();
  const auto found = answer({scene, "--a", "settings.tick_hz=40", "--b", "settings.tick_hz=60",
                             "--seconds", "1", "--tolerance", "1e-9", "--csv", csv},
                            0);
  CHECK(found["moments"] == 21);  // every twentieth of a second
  CHECK(found["last"]["tick_a"] == 40);
  CHECK(found["last"]["tick_b"] == 60);
  std::ifstream in(csv);
  int lines = 0;
  for (std::string row; std::getline(in, row);) ++lines;
  CHECK(lines == 22);
}

TEST_CASE("verify refuses what it cannot compare") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", falling());
  CHECK(tumble_program({"verify", scene, "--a", "bodies.nobody.mass=3"}).code == 2);
  CHECK(tumble_program({"verify", scene, "--tolerance", "-1"}).code == 2);
  CHECK(tumble_program({"verify", (folder / "none.json").string()}).code == 3);
  CHECK(tumble_program({"verify", scene, "--csv", "/nowhere/x.csv"}).code == 5);
}

TEST_CASE(
    "a fault of one side's option names that option, and a body of one side has no distance") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", falling());
  for (const std::string option : {"--a", "--b", "--set"}) {
    const ProgramRun run = tumble_program({"verify", scene, option, "bodies.nobody.mass=3"});
    CHECK(run.code == 2);
    CHECK_MESSAGE(mentions(run.err, option + ": bodies.nobody"), run.err);
  }
  const ProgramRun alone = tumble_program({"verify", scene, "--b", "bodies.ball.present=false"});
  CHECK(alone.code == 1);
  CHECK_MESSAGE(mentions(alone.out, "ball, which only one of the two worlds has"), alone.out);
  CHECK_FALSE(mentions(alone.out, "inf"));
}

TEST_CASE("threads and instruction sets are chosen like settings, and named where they differ") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const auto found = answer({scene, "--a", "simd=" + simd_targets().back(), "--a", "threads=2",
                             "--b", "threads=3", "--seconds", "0.5"},
                            0);
  REQUIRE(found["differences"].size() == 2);
  CHECK(found["differences"][0]["path"] == "threads");
  CHECK(found["differences"][1]["path"] == "simd");
  CHECK(found["differences"][1]["a"] == simd_targets().back());
  for (const std::string wrong : {"simd=ABACUS", "threads=-1", "threads=many"}) {
    const ProgramRun run = tumble_program({"verify", scene, "--b", wrong});
    CHECK(run.code == 2);
    CHECK_MESSAGE(mentions(run.err, "--b " + wrong), run.err);
  }
}

TEST_CASE("bodies that stand in other slots are compared by name, and a contact is named") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", R"({"tumble_scene": 1,
    "parameters": {"n": 1}, "bodies": {
    "floor": {"type": "static", "shape": {"type": "half_space"}},
    "first": {"shape": {"type": "sphere", "radius": 0.1}, "position": [3, 5, 0],
              "repeat": {"type": "stack", "count": "$n", "step": [1, 0, 0]}},
    "ball": {"shape": {"type": "sphere", "radius": 0.1}, "position": [0, 0.1, 0]}}})");
  const auto found = answer({scene, "--b", "parameters.n=2", "--seconds", "0.1"}, 1);
  CHECK(found["first"]["what"] == "first[1]");
  CHECK(found["first"]["angle"] == 0);
  CHECK(found["first"]["speed"] == 0);
  const auto heavy = answer({scene, "--b", "settings.gravity=[0,-20,0]"}, 1);
  CHECK(heavy["first_contact"].get<std::string>().find("ball") != std::string::npos);
  const auto body =
      answer({scene, "--b", "bodies.ball.mass=3", "--tolerance", "0.01", "--seconds", "0.1"}, 0);
  CHECK(body["differences"].back()["path"] == "bodies.ball.mass");
  CHECK(body["differences"].back()["b"] == "3");
}

TEST_CASE("numbers out of range are told with their option") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", falling());
  for (const char* option : {"--seconds", "--tolerance"})
    for (const char* value : {"nan", "-1", "inf", "1e12"}) {
      const ProgramRun run = tumble_program({"verify", scene, option, value});
      CAPTURE(value);
      CHECK(run.code == 2);
      CHECK_MESSAGE(mentions(run.err, option), run.err);
      CHECK_MESSAGE(mentions(run.err, std::string("'") + value + "'"), run.err);
    }
}

TEST_CASE("of a path that is given twice the last value counts, in the list too") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", falling());
  const auto found = answer({scene, "--a", "bodies.ball.mass=3", "--a", "bodies.ball.mass=4", "--b",
                             "bodies.ball.mass=8", "--seconds", "0.1"},
                            0);
  int rows = 0;
  for (const auto& row : found["differences"]) {
    if (row["path"] != "bodies.ball.mass") continue;  // the two sides have other threads, too
    ++rows;
    CHECK(row["a"] == "4");
    CHECK(row["b"] == "8");
  }
  CHECK(rows == 1);
}

TEST_CASE("what differs in velocities alone has no place where it is worst") {
  TempFolder folder;
  // It turns, and goes nowhere.
  const std::string scene = write_text(folder / "s.json", R"({"tumble_scene": 1,
    "settings": {"gravity": [0, 0, 0]}, "bodies": {
    "ball": {"shape": {"type": "sphere", "radius": 0.1}, "angular_velocity": [0, 1, 0]}}})");
  const ProgramRun run = tumble_program(
      {"verify", scene, "--b", "bodies.ball.angular_velocity=[0,2,0]", "--seconds", "0.1"});
  CHECK(run.code == 1);
  CHECK_MESSAGE(!mentions(run.out, "worst:"), run.out);
}
