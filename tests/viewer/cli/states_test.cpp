// States that are drawn without simulating. Reference: the pictures and state hashes of a run that
// simulates, bit for bit, over moving and new bodies, contacts, smoke and coloured particles, at
// ticks and between them. Needs a renderer (EGL or OSMesa).
#include "engine/core/hash.hpp"
#include "tests/viewer/cli/program.hpp"
#include "viewer/capture/frames_file.hpp"
#include "viewer/capture/states/state_list.hpp"

#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;

namespace {

/// Crates and grains that fall and pile up, smoke, coloured drops; `look` goes into the scene.
std::string lively_scene(const std::string& look = "\"exposure\": 1") {
  return R"({
  "tumble_scene": 1,
  "settings": {"tick_hz": 60},
  "bodies": {
    "floor": {"type": "static", "shape": {"type": "half_space"}},
    "ball": {"position": [0, 1, 0], "shape": {"type": "sphere", "radius": 0.25}},
    "crate": {"present": false, "shape": {"type": "box", "size": [0.2, 0.2, 0.2]}},
    "box": {"position": [0.6, 0.8, 0], "shape": {"type": "box", "size": [0.4, 0.4, 0.4]},
            "repeat": [{"type": "stack", "count": 2, "step": [0, 0.5, 0]}]}
  },
  "particles": {
    "drops": {"radius": 0.05, "fast": true, "look": {"colour_by": "speed"}},
    "smoke": {"radius": 0.1, "collide": false, "gravity_scale": 0, "look": "smoke"}},
  "emitters": {
    "vent": {"particles": "smoke", "position": [-0.5, 0.2, 0], "rate": 30, "speed": 1, "life": 0.5,
             "opacity_over_life": [1, 0]},
    "tap": {"particles": "drops", "position": [0, 1.5, 0.4], "rate": 100, "speed": 1, "life": 1,
            "spread_deg": 40},
    "crates": {"body": "crate", "position": [-0.6, 1, 0.4], "rate": 4, "at_most": 9}},
  "cameras": {"main": {"position": [2, 1.5, 3], "target": [0, 0.5, 0]},
              "near": {"position": [1, 1, 2], "target": [0, 0.4, 0], "follow": "ball"}},
  "look": {)" +
         look + "}\n}";
}

struct States {
  TempFolder folder;
  std::string scene = write_text(folder / "s.json", lively_scene());

  std::string at(const std::string& name) const { return (folder / name).string(); }
  ProgramRun simulate(const std::string& states, std::vector<std::string> more,
                      const ProgramOptions& options = {}) const {
    std::vector<std::string> all = {"simulate", scene, "--states", at(states)};
    all.insert(all.end(), more.begin(), more.end());
    return tumble_program(all, options);
  }
  ProgramRun render(const std::string& out, std::vector<std::string> more) const {
    std::vector<std::string> all = {"render", scene, "-o", at(out), "--size", "96x64"};
    all.insert(all.end(), more.begin(), more.end());
    return tumble_program(all);
  }
  /// Image and state hashes of a sequence, by frame.
  std::vector<std::pair<std::string, std::string>> hashes(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder / name / "frames.json").rdbuf();
    std::vector<std::pair<std::string, std::string>> out;
    const auto json = nlohmann::json::parse(text.str(), nullptr, false);
    REQUIRE(json.is_object());
    for (const auto& frame : json.at("frames"))
      out.emplace_back(frame.at("image_hash"), frame.at("state_hash"));
    return out;
  }
};

}  // namespace

TEST_CASE("pictures drawn from states are those of a run that simulates, to the last bit") {
  const States s;
  using Arguments = std::vector<std::string>;
  // Every second tick; two of three between ticks.
  for (const auto& [fps, look] :
       {std::pair{std::string("30"), Arguments{"--overlay", "contacts,islands,aabbs"}},
        {"40", {"--camera", "near"}}}) {
    const auto& shown_fps = fps;
    CAPTURE(shown_fps);
    const std::string states = "states" + fps;
    const ProgramRun saved = s.simulate(states, {"--seconds", "0.5", "--fps", fps});
    REQUIRE_MESSAGE(saved.code == 0, saved.err);
    Arguments drawn = look, simulated = look;
    drawn.insert(drawn.end(), {"--states", s.at(states), "--force"});
    simulated.insert(simulated.end(), {"--seconds", "0.5", "--fps", fps, "--force"});
    const ProgramRun a = s.render("a", drawn), b = s.render("b", simulated);
    REQUIRE_MESSAGE(a.code == 0, a.err);
    REQUIRE_MESSAGE(b.code == 0, b.err);
    CHECK(s.hashes("a").size() == (fps == "30" ? 15 : 20));
    CHECK(s.hashes("a") == s.hashes("b"));
  }
}

TEST_CASE("states are drawn in other colours and light, and what moves the world is refused") {
  const States s;
  REQUIRE(s.simulate("states", {"--seconds", "0.3"}).code == 0);
  const auto drawn = [&](const std::string& out, std::vector<std::string> sets) {
    std::vector<std::string> all = {"--states", s.at("states"), "--frames", "9"};
    for (const std::string& set : sets) all.insert(all.end(), {"--set", set});
    return s.render(out, all);
  };
  // The crate is there only as the copies that an emitter makes.
  const std::vector<std::string> changes = {"bodies.ball.colour=\"#ff0000\"",
                                            "bodies.crate.colour=\"#00ff00\"", "look.exposure=2",
                                            "particles.drops.look.range=[0,9]"};
  REQUIRE(drawn("plain", {}).code == 0);
  const ProgramRun changed = drawn("changed", changes);
  REQUIRE_MESSAGE(changed.code == 0, changed.err);
  std::vector<std::string> simulated = {"--frames", "9"};
  for (const std::string& change : changes) simulated.insert(simulated.end(), {"--set", change});
  REQUIRE(s.render("simulated", simulated).code == 0);
  CHECK(s.hashes("changed") == s.hashes("simulated"));
  CHECK(s.hashes("changed") != s.hashes("plain"));

  const ProgramRun moved = drawn("moved", {"settings.gravity=[0,0,0]"});
  CHECK(moved.code == 2);
  CHECK(mentions(moved.err, "hold how everything moves"));
  const ProgramRun unknown = drawn("unknown", {"particles.drops.look.colour_by=age"});
  CHECK(unknown.code == 2);
  CHECK(mentions(unknown.err, "look.range="));
}

TEST_CASE("states of another scene, of too few ticks or damaged ones are refused") {
  const States s;
  REQUIRE(s.simulate("states", {"--seconds", "0.3"}).code == 0);
  const auto drawn = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--states", s.at("states"), "--force"});
    return s.render("out", more);
  };
  CHECK(drawn({}).code == 0);
  const ProgramRun finer = drawn({"--fps", "60"});
  CHECK(finer.code == 2);
  CHECK(mentions(finer.err, "30/s"));
  const ProgramRun finest = drawn({"--fps", "1000000000000"});
  CHECK(finest.code == 2);
  CHECK(mentions(finest.err, "it must be 1 to"));
  CHECK(drawn({"--seconds", "2"}).code == 2);
  const ProgramRun arrows = drawn({"--overlay", "total_forces"});
  CHECK(arrows.code == 2);
  CHECK(mentions(arrows.err, "every tick"));

  const auto list = read_state_list(s.folder / "states");
  REQUIRE(list.ok());
  const auto file = s.folder / "states" / state_file_name(list->states[3].tick);
  std::ofstream(file, std::ios::app) << "x";
  const ProgramRun damaged = drawn({});
  CHECK(damaged.code == 3);
  CHECK(mentions(damaged.err, file.filename().string()));

  write_text(s.folder / "s.json", lively_scene("\"ground\": {\"visible\": false}"));
  CHECK(drawn({"--frames", "2"}).code == 0);  // how it looks is the scene's of now
  std::string other = lively_scene();
  other.replace(other.find("0.25}"), 5, "0.26}");
  write_text(s.folder / "s.json", other);
  const ProgramRun another = drawn({});
  CHECK(another.code == 2);
  CHECK(mentions(another.err, "another scene"));
}

TEST_CASE("a list of states with rates that no frame can be timed by is none") {
  const TempFolder folder;
  StateList list;
  REQUIRE(write_state_list(folder.path(), list).ok());
  CHECK(read_state_list(folder.path()).ok());
  for (int64_t* term : {&list.fps.num, &list.fps.den, &list.rate.num, &list.rate.den}) {
    const int64_t good = *term;
    for (const int64_t bad : {int64_t{0}, greatest_term + 1}) {
      *term = bad;
      REQUIRE(write_state_list(folder.path(), list).ok());
      CHECK_FALSE(read_state_list(folder.path()).ok());
    }
    *term = good;
  }
}

TEST_CASE("an interrupted run goes on from its last state, to the same bits") {
  const States s;
  REQUIRE(s.simulate("whole", {"--seconds", "0.7"}).code == 0);
  REQUIRE(s.simulate("part", {"--seconds", "0.3"}).code == 0);
  CHECK(s.simulate("part", {"--seconds", "0.7"}).code == 5);
  const ProgramRun resumed = s.simulate("part", {"--seconds", "0.7", "--resume", "--hash"});
  REQUIRE_MESSAGE(resumed.code == 0, resumed.err);
  CHECK(mentions(resumed.err, "9 of them there before"));
  const auto whole = read_state_list(s.folder / "whole"), part = read_state_list(s.folder / "part");
  REQUIRE(whole.ok());
  REQUIRE(part.ok());
  REQUIRE(whole->states.size() == 21);
  REQUIRE(part->states.size() == 21);
  for (size_t i = 0; i < whole->states.size(); ++i)
    CHECK(whole->states[i].state_hash == part->states[i].state_hash);
  CHECK(s.simulate("part", {"--seconds", "0.7", "--resume", "--set", "settings.tick_hz=50"}).code ==
        5);
  // With something that is of the whole run it is simulated from the start, and compared.
  CHECK(s.simulate("part", {"--seconds", "0.7", "--resume", "--csv", s.at("e.csv")}).code == 0);
  // The end of a run that is there already is simulated again: what a tick counted is in no state.
  const ProgramRun ended =
      s.simulate("part", {"--steps", "40", "--resume", "--assert", "contacts > 0"});
  CHECK_MESSAGE(ended.code == 0, ended.err);
}
