// `tumble pack`, `keys`, and `check --run` of lessons. References: the scene before it was packed;
// files written by hand.
#include "tests/viewer/cli/program.hpp"
#include "tests/viewer/cli/recorded_run.hpp"

#include <fstream>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;

namespace {

bool has_words(const std::string& text, std::string_view words) {
  return text.find(words) != std::string::npos;
}

ProgramOptions with_folder(const char* variable, const std::filesystem::path& folder) {
  ProgramOptions options;
  options.environment = {{variable, folder.string()}};
  return options;
}

std::string bytes_in(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

}  // namespace

TEST_CASE("the replay of a pack is played, unless another is given or none is wanted") {
  TempFolder folder;
  const ProgramOptions home = with_folder("XDG_CACHE_HOME", folder / "cache");
  const std::string scene = write_text(folder / "s.json", small_scene());
  const std::string pack = (folder / "s.tumble").string(), one = (folder / "one.bin").string(),
                    two = (folder / "two.bin").string();
  const std::string first = record(scene, one, 2) + "\n", second = record(scene, two, -3) + "\n";
  REQUIRE(first != second);
  const auto simulated = [&](std::vector<std::string> more) {
    more.insert(more.begin(), "simulate");
    return tumble_program(more, home);
  };
  // It ends where the replay does, which tells how long that is.
  CHECK(simulated({scene, "--play", one, "--hash"}).out == first);
  REQUIRE(tumble_program({"pack", scene, pack, "--replay", one}, home).code == 0);
  const ProgramRun played = simulated({pack, "--hash"});
  CHECK(played.code == 0);
  CHECK(played.out == first);
  CHECK(has_words(played.err, "s.tumble is played, 40 ticks"));
  const ProgramRun given = simulated({pack, "--play", two, "--hash"});
  CHECK(given.out == second);
  CHECK(has_words(given.err, "two.bin is played"));
  CHECK(has_words(given.err, "the one in the pack is not"));
  // Without it the scene goes its own way, and nobody knows for how long.
  CHECK(simulated({pack, "--no-replay", "--hash"}).code == 2);
  const ProgramRun plain = simulated({scene, "--steps", "40", "--hash"});
  CHECK(simulated({pack, "--no-replay", "--steps", "40", "--hash"}).out == plain.out);
  CHECK(plain.out != first);
  // A run that is shorter, or goes on afterwards, is right too.
  CHECK(simulated({pack, "--steps", "9", "--hash"}).out ==
        simulated({scene, "--steps", "9", "--hash"}).out);
  CHECK(simulated({pack, "--steps", "60"}).code == 0);
  // What is recorded of it is the same replay again.
  const std::string again = (folder / "again.bin").string();
  CHECK(simulated({pack, "--replay", again}).code == 0);
  CHECK(bytes_in(again) == bytes_in(one));
  // Of another beginning it cannot be.
  const ProgramRun other = simulated({pack, "--set", "bodies.ball.mass=3"});
  CHECK(other.code == 2);
  CHECK(has_words(other.err, "begins otherwise"));
  CHECK(has_words(other.err, "--no-replay"));
  CHECK(simulated({scene, "--play", (folder / "none.bin").string()}).code != 0);
  CHECK(simulated({pack, "--play", one, "--no-replay"}).code == 2);
}

TEST_CASE("a pack stands for its scene in every command, with a replay that holds") {
  TempFolder folder;
  const ProgramOptions home = with_folder("XDG_CACHE_HOME", folder / "cache");
  const std::string scene = write_text(folder / "s.json", small_scene());
  const std::string pack = (folder / "s.tumble").string(), replay = (folder / "run.bin").string();
  const ProgramRun run =
      tumble_program({"simulate", scene, "--seconds", "0.5", "--hash", "--replay", replay});
  REQUIRE(run.code == 0);
  // What was recorded is not lost by a second run that names it too.
  std::vector<std::string> again = {"simulate", scene, "--seconds", "0.5", "--replay", replay};
  CHECK(tumble_program(again).code == 5);
  again.push_back("--force");
  CHECK(tumble_program(again).code == 0);
  REQUIRE(tumble_program({"pack", scene, pack, "--replay", replay}, home).code == 0);
  std::filesystem::remove(scene);
  CHECK(tumble_program({"simulate", pack, "--seconds", "0.5", "--hash"}, home).out == run.out);
  const ProgramRun check = tumble_program({"check", pack, "--run", "--json"}, home);
  CHECK(check.code == 0);
  CHECK(nlohmann::json::parse(check.out)["files"][0]["replay_holds"] == true);
  CHECK(tumble_program({"verify", pack, "--seconds", "0.2"}, home).code == 0);
  // It is there already.
  CHECK(tumble_program({"pack", "hello", pack}, home).code == 5);
  CHECK(tumble_program({"pack", "hello", "-o", pack, "--force"}, home).code == 0);
  CHECK(tumble_program({"pack", "hello", (folder / "nowhere/a.tumble").string()}, home).code == 5);
  CHECK(tumble_program({"pack", (folder / "none.json").string(), pack, "--force"}, home).code == 3);
  CHECK(tumble_program({"pack", "hello"}, home).code == 2);
  // The name may come in either way, so that neither of the two is what one must give.
  const std::string help = tumble_program({"pack", "--help"}, home).out;
  CHECK(help.find("REQUIRED") == help.rfind("REQUIRED"));
  write_text(replay, "no replay");
  CHECK(tumble_program({"pack", "hello", pack, "--force", "--replay", replay}, home).code == 3);
  // One that ends early.
  const std::string whole = bytes_in(pack);
  write_text(pack, whole.substr(0, whole.size() / 2));
  const ProgramRun broken = tumble_program({"check", pack}, home);
  CHECK(broken.code == 3);
  CHECK(has_words(broken.err, "damaged, or ends early"));
}

TEST_CASE("a replay of another beginning is not packed") {
  TempFolder folder;
  const ProgramOptions home = with_folder("XDG_CACHE_HOME", folder / "cache");
  std::string text = small_scene();
  const std::string scene = write_text(folder / "s.json", text);
  const std::string replay = (folder / "run.bin").string(), pack = (folder / "s.tumble").string();
  record(scene, replay, 2);
  // Other settings, another scene.
  write_text(folder / "t.json",
             text.replace(text.find("\"bodies\""), 0, "\"settings\": {\"gravity\": [0, -5, 0]}, "));
  for (const std::string& other : {(folder / "t.json").string(), std::string("hello")}) {
    const ProgramRun run = tumble_program({"pack", other, pack, "--replay", replay}, home);
    CHECK(run.code == 3);
    CHECK(has_words(run.err, "begins otherwise than the scene"));
    CHECK(has_words(run.err, "run.bin"));
    CHECK_FALSE(std::filesystem::exists(pack));
  }
  CHECK(tumble_program({"pack", scene, pack, "--replay", replay}, home).code == 0);
}

TEST_CASE("check --run compares a lesson with its world") {
  const std::vector<std::string> line = {"check", "lesson_09_mass_properties", "--run", "--json"};
  const ProgramRun good = tumble_program(line);
  CHECK(good.code == 0);
  const auto lesson = nlohmann::json::parse(good.out)["files"][0]["lesson"];
  REQUIRE(lesson.size() == 2);
  CHECK(lesson[0]["answer"] == 72);
  CHECK(lesson[0]["holds"] == true);
  const ProgramRun bad = tumble_program(
      {"check", "lesson_09_mass_properties", "--run", "--set", "bodies.brick.density=1000"});
  CHECK(bad.code == 1);
  CHECK(has_words(bad.err, "page 1 of the lesson"));
  CHECK(has_words(bad.err, "the answer is 72 within 0.1, but the world says 40"));
  TempFolder folder;
  const std::string scene = write_text(folder / "l.json", R"({"tumble_scene": 1, "bodies": {},
    "lesson": {"steps": [{"title": "t", "text": ["x"], "plot": ["energie"],
      "choose": ["parameters.n=3"]}]}})");
  const ProgramRun faulty = tumble_program({"check", scene});
  CHECK(faulty.code == 3);
  CHECK(has_words(faulty.err,
                  "lesson.steps[0].plot[0]: unknown quantity 'energie', did you mean 'energy'?"));
  CHECK(has_words(faulty.err, "lesson.steps[0].choose: cannot be chosen"));
}

TEST_CASE("keys lists every action, with those of one's own") {
  TempFolder folder;
  const ProgramOptions home = with_folder("XDG_CONFIG_HOME", folder / "config");
  const ProgramRun usual = tumble_program({"keys"}, home);
  CHECK(usual.code == 0);
  CHECK(has_words(usual.out, "toggle_pause             Space            pause and go on"));
  std::filesystem::create_directories(folder / "config/tumble");
  write_text(folder / "config/tumble/keys.json", R"({"toggle_pause": "F2", "quit": ""})");
  const ProgramRun own = tumble_program({"keys"}, home);
  CHECK(own.code == 0);
  CHECK(has_words(own.out, "F2               pause and go on (usually Space)"));
  write_text(folder / "config/tumble/keys.json", R"({"toggle_pause": "F2", "qiut": "F3"})");
  const ProgramRun wrong = tumble_program({"keys", "--json"}, home);
  CHECK(wrong.code == 3);
  CHECK(has_words(wrong.err, "keys.json: qiut: unknown action 'qiut', did you mean 'quit'?"));
  const auto json = nlohmann::json::parse(wrong.out);
  CHECK(json["keys"][0]["chords"][0] == "F2");
  CHECK(json["faults"].size() == 1);
}
