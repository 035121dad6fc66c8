// Reference: the hash of another run with other threads; free fall in closed form; the files are
// read back by an independent reader (line by line, nlohmann-json).
#include "tests/viewer/cli/program.hpp"

#include <algorithm>
#include <csignal>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

bool is_hash(const std::string& text) {
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::string read_all(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

}  // namespace

TEST_CASE("the hash is the last line, the same for every run and number of threads") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  std::string first;
  for (const char* threads : {"1", "2", "4", "1"}) {
    const ProgramRun run =
        tumble_program({"simulate", scene, "--seconds", "1.5", "--threads", threads, "--hash=30"});
    REQUIRE(run.code == 0);
    const auto lines = lines_of(run.out);
    REQUIRE(lines.size() == 3);  // ticks 30 and 60, and the final one
    CHECK(lines[0].starts_with("30 "));
    CHECK(is_hash(lines.back()));
    if (first.empty()) first = run.out;
    CHECK(run.out == first);
  }
  const ProgramRun heavier = tumble_program(
      {"simulate", scene, "--seconds", "1.5", "--hash", "--set", "settings.gravity=[0,-5,0]"});
  CHECK(lines_of(heavier.out).back() != lines_of(first).back());
}

TEST_CASE("assertions decide between 0 and 1 and print what they saw") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  CHECK(tumble_program({"simulate", scene, "--seconds", "3", "--assert",
                        "bodies.ball.position.y > 0.24 && bodies.ball.position.y < 0.26"})
            .code == 0);
  const ProgramRun run = tumble_program({"simulate", scene, "--seconds", "1", "--assert",
                                         "bodies.ball.position.y > 5", "--assert", "time == 1"});
  CHECK(run.code == 1);
  CHECK(mentions(run.err, "bodies.ball.position.y = "));
  CHECK_FALSE(mentions(run.err, "time == 1"));
}

TEST_CASE("the CSV has a row a tick, and its energy is that of free fall") {
  TempFolder folder;
  const std::string scene = write_text(folder / "fall.json", R"({"tumble_scene": 1, "bodies": {
    "ball": {"position": [0, 100, 0], "mass": 2, "shape": {"type": "sphere", "radius": 0.5}}}})");
  const auto csv = folder / "out.csv";
  REQUIRE(tumble_program({"simulate", scene, "--seconds", "1", "--csv", csv.string()}).code == 0);
  const auto lines = lines_of(read_all(csv));
  REQUIRE(lines.size() == 1 + 61);
  CHECK(lines[0].starts_with("tick,time_s,kinetic_J,gravity_J,springs_J,fields_J,total_J,"));
  for (const char* stage : {",broad phase_ms", ",solve_ms", ",publish_ms"})
    CHECK_MESSAGE(lines[0].find(stage) != std::string::npos, stage, lines[0]);
  std::istringstream last(lines.back());
  std::vector<double> values;
  for (std::string cell; std::getline(last, cell, ',');) values.push_back(std::stod(cell));
  CHECK(values[0] == 60);
  CHECK(values[1] == doctest::Approx(1));
  // After 1 s: m v^2 / 2 with v = g t; the height differs by the integrator's g t h / 2 at most.
  CHECK(values[2] == doctest::Approx(9.81 * 9.81).epsilon(1e-6));
  CHECK(values[6] == doctest::Approx(2 * 9.81 * 100).epsilon(2e-3));
}

TEST_CASE("every cause has its columns, and named forces theirs, the work of gravity is m g h") {
  TempFolder folder;
  const std::string scene = write_text(folder / "fall.json", R"({"tumble_scene": 1, "bodies": {
    "ball": {"position": [0, 100, 0], "mass": 2, "shape": {"type": "sphere", "radius": 0.5}}},
    "forces": {"air": {"type": "linear_drag", "rate": 0.1}}})");
  const auto csv = folder / "out.csv";
  REQUIRE(tumble_program({"simulate", scene, "--seconds", "1", "--csv", csv.string()}).code == 0);
  const auto lines = lines_of(read_all(csv));
  const auto cell = [&](const std::string& row, const std::string& column) {
    std::istringstream names(lines[0]), values(row);
    std::string name, value;
    while (std::getline(names, name, ',') && std::getline(values, value, ','))
      if (name == column) return std::stod(value);
    FAIL("no column ", column);
    return 0.0;
  };
  const double fallen = cell(lines[1], "gravity_J") - cell(lines.back(), "gravity_J");
  CHECK(cell(lines.back(), "gravity_work_J") == doctest::Approx(fallen).epsilon(1e-9));
  CHECK(cell(lines.back(), "gravity_balance_J") == 0);
  const double lost = cell(lines[1], "total_J") - cell(lines.back(), "total_J");
  CHECK(cell(lines.back(), "force_air_balance_J") == doctest::Approx(-lost).epsilon(1e-9));
  CHECK(cell(lines.back(), "energy_drift") < 1e-9);
}

TEST_CASE("coordinates, motors and reactions of joints can be asserted, and whether they broke") {
  TempFolder folder;
  // Bars of 2 kg hang from hinges; one is held level by a motor, one hinge is too weak.
  const std::string bars = R"({"tumble_scene": 1, "bodies": {
      "arm": {"shape": {"type": "box", "size": [1, 0.1, 0.1]}, "mass": 2, "position": [0.5, 5, 0]},
      "weak": {"shape": {"type": "box", "size": [1, 0.1, 0.1]}, "mass": 2, "position": [0, 5, 3]}},
    "joints": {
      "servo": {"kind": "revolute", "b": "arm", "anchor": [0, 5, 0],
        "motor": {"position_deg": 0, "stiffness": 2000, "damping": 200}},
      "pin": {"kind": "rigid", "b": "weak", "anchor": [0, 5, 3], "break_force": 10}}})";
  const std::string scene = write_text(folder / "s.json", bars);
  CHECK(
      tumble_program(
          {"simulate", scene, "--seconds", "4", "--joints", (folder / "j.csv").string(), "--assert",
           "abs(joints.servo.angle) < 0.01 && abs(joints.servo.rate) < 0.001", "--assert",
           "abs(joints.servo.motor - 9.81) < 0.05 && abs(joints.servo.angle_motor - 9.81) < 0.05",
           "--assert",
           "abs(sqrt(joints.servo.reaction.x^2 + joints.servo.reaction.y^2) - 19.62) < 0.2",
           "--assert", "joints.pin.broken == 1 && joints.servo.broken == 0 && joints == 1"})
          .code == 0);
  CHECK(mentions(read_all(folder / "j.csv"), "value_1,rate_1,motor_1"));
}

TEST_CASE("--csv knows what joints do by the names of --assert") {
  TempFolder folder;
  // A door of 2 kg turns about its centre at 2 rad/s; 5 N push a slide of 1 kg across its weight.
  const std::string scene = write_text(folder / "s.json", R"({"tumble_scene": 1, "bodies": {
      "leaf": {"shape": {"type": "box", "size": [1, 1, 0.1]}, "mass": 2},
      "sled": {"shape": {"type": "box", "size": [0.2, 0.2, 0.2]}, "mass": 1, "position": [5, 0, 0]}},
    "joints": {
      "door": {"kind": "revolute", "b": "leaf", "axis": [0, 1, 0], "motor": {"velocity": 2}},
      "rail": {"kind": "prismatic", "b": "sled", "anchor": [5, 0, 0], "axis": [1, 0, 0],
               "motor": {"force": 5}}}})");
  for (const char* stepper : {"event", "realtime"}) {
    CAPTURE(stepper);
    const auto csv = folder / (std::string(stepper) + ".csv");
    REQUIRE(tumble_program({"simulate", scene, "--seconds", "1", "--stepper", stepper, "--csv",
                            csv.string(), "--assert", "abs(joints.door.motor_torque) < 1e-6",
                            "--assert", "abs(joints.door.angle_deg - 2 * 180 / pi) < 1e-6",
                            "--assert", "joints.rail.motor_force == joints.rail.position_motor"})
                .code == 0);
    const auto lines = lines_of(read_all(csv));
    const auto cell = [&](const std::string& column) {
      std::istringstream names(lines[0]), values(lines.back());
      std::string name, value;
      while (std::getline(names, name, ',') && std::getline(values, value, ','))
        if (name == column) return std::stod(value);
      FAIL("no column ", column);
      return 0.0;
    };
    CHECK(cell("joints.door.angle") == doctest::Approx(2).epsilon(1e-9));
    CHECK(cell("joints.door.rate") == doctest::Approx(2).epsilon(1e-9));
    CHECK(std::fabs(cell("joints.door.motor_torque")) < 1e-6);
    CHECK(cell("joints.door.reaction.z") == doctest::Approx(2 * 9.81).epsilon(1e-6));
    CHECK(cell("joints.rail.rate") == doctest::Approx(5).epsilon(1e-6));
    CHECK(cell("joints.rail.position") == doctest::Approx(2.5).epsilon(0.02));
    CHECK(cell("joints.rail.motor_force") == doctest::Approx(5).epsilon(1e-9));
  }
}

TEST_CASE("the ledger can be asserted, an unknown name says what was meant and ends with 2") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  CHECK(tumble_program({"simulate", scene, "--seconds", "1", "--assert", "energy.drift<0.05",
                        "--assert", "ledger.gravity.work > 0 && ledger.restitution < 0"})
            .code == 0);
  CHECK(tumble_program({"simulate", scene, "--seconds", "1", "--assert", "energy.drift<-1"}).code ==
        1);
  const ProgramRun run =
      tumble_program({"simulate", scene, "--seconds", "1", "--assert", "energy.drfit<1e-6"});
  CHECK(run.code == 2);
  CHECK(mentions(run.err, "did you mean 'energy.drift'?"));
  const ProgramRun line =
      tumble_program({"simulate", scene, "--seconds", "1", "--assert", "ledger.fricton<0"});
  CHECK(line.code == 2);
  CHECK(mentions(line.err, "did you mean 'ledger.friction'?"));
}

TEST_CASE("--convergence finds the second order of the realtime stepper on a smooth scene") {
  TempFolder folder;
  const std::string scene = write_text(folder / "orbit.json", R"({"tumble_scene": 1,
    "settings": {"tick_hz": 120, "gravity": [0, 0, 0]}, "bodies": {
    "moon": {"position": [1, 0, 0], "velocity": [0, 0, -1.2], "shape": {"type": "sphere", "radius": 0.1}}},
    "forces": {"earth": {"type": "point_gravity", "mu": 2}}})");
  const ProgramRun run =
      tumble_program({"simulate", scene, "--seconds", "2", "--convergence", "--json"});
  REQUIRE(run.code == 0);
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  REQUIRE(json.is_object());
  CHECK(json["position"]["order"].get<double>() == doctest::Approx(2).epsilon(0.05));
  CHECK(json["energy"]["order"].get<double>() == doctest::Approx(2).epsilon(0.1));
  CHECK(json["position"]["errors"][2].get<double>() < 1e-4);
  const ProgramRun table = tumble_program({"simulate", scene, "--seconds", "1", "--convergence"});
  CHECK(table.code == 0);
  CHECK(mentions(table.out, "order"));
  CHECK(mentions(table.out, "position [m]"));
  CHECK(tumble_program({"simulate", scene, "--seconds", "1", "--convergence", "--hash"}).code == 2);
  // Three runs are none that a replay could be of.
  const ProgramRun replay = tumble_program(
      {"simulate", scene, "--seconds", "1", "--convergence", "--replay", "convergence.replay"});
  CHECK(replay.code == 2);
  CHECK(mentions(replay.err, "--replay"));
}

TEST_CASE("--convergence finds the order of every integrator under the event stepper") {
  // A box that tumbles round a star on a damped spring, in thin air.
  TempFolder folder;
  const std::string scene = write_text(folder / "smooth.json", R"({"tumble_scene": 1,
    "settings": {"stepper": "event", "gravity": [0, -1, 0]}, "bodies": {
    "moon": {"position": [1, 0, 0], "velocity": [0, 0.3, -1.2], "angular_velocity": [0.4, 1, 2],
             "mass": 2, "shape": {"type": "box", "size": [0.2, 0.4, 0.1]}}},
    "forces": {"star": {"type": "point_gravity", "mu": 2},
               "air": {"type": "linear_drag", "rate": 0.1, "angular_rate": 0.2},
               "rope": {"type": "spring", "a": {"point": [0, 2, 0]}, "b": {"body": "moon", "point": [0.1, 0, 0]},
                        "stiffness": 6, "damping": 0.4}}})");
  struct Method {
    const char* name;
    double order;
    int hz;
  };
  for (const Method& m :
       {Method{"explicit_euler", 1, 1920}, Method{"semi_implicit_euler", 1, 1920},
        Method{"implicit_euler", 1, 1920}, Method{"rk2", 2, 240}, Method{"rk4", 4, 20}}) {
    CAPTURE(m.name);
    const ProgramRun run =
        tumble_program({"simulate", scene, "--seconds", "1", "--convergence", "--json", "--set",
                        std::string("settings.event.integrator=") + m.name, "--set",
                        "settings.tick_hz=" + std::to_string(m.hz)});
    REQUIRE_MESSAGE(run.code == 0, run.err);
    const auto json = nlohmann::json::parse(run.out, nullptr, false);
    REQUIRE(json.is_object());
    for (const char* what : {"position", "orientation", "velocity"}) {
      CAPTURE(what);
      CHECK(json[what]["order"].get<double>() > m.order - 0.2);
      CHECK(json[what]["order"].get<double>() < m.order + 0.6);
    }
  }
  const ProgramRun adaptive = tumble_program({"simulate", scene, "--seconds", "1", "--convergence",
                                              "--json", "--set", "settings.event.integrator=rk45"});
  REQUIRE(adaptive.code == 0);
  const auto json = nlohmann::json::parse(adaptive.out, nullptr, false);
  for (const auto& error : json["position"]["errors"]) CHECK(error.get<double>() < 1e-7);
}

TEST_CASE("contacts and trace are what their readers expect") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const auto contacts = folder / "contacts.csv", trace = folder / "trace.json";
  REQUIRE(tumble_program({"simulate", scene, "--seconds", "2", "--contacts", contacts.string(),
                          "--trace", trace.string()})
              .code == 0);
  const auto rows = lines_of(read_all(contacts));
  REQUIRE(rows.size() > 50);
  CHECK(std::any_of(rows.begin() + 1, rows.end(),
                    [](const std::string& row) { return mentions(row, "floor"); }));
  const auto json = nlohmann::json::parse(read_all(trace), nullptr, false);
  REQUIRE(json.is_object());
  REQUIRE(json["traceEvents"].size() > 240);
  for (const auto& event : json["traceEvents"]) {
    CHECK(event["ph"] == "X");
    CHECK(event["dur"].get<double>() >= 0);
  }
}

TEST_CASE("a file of joints has a row for each joint and tick, from the start on") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", R"({"tumble_scene": 1,
    "bodies": {"bob": {"position": [0, -1, 0], "mass": 2,
                       "shapes": [{"type": "sphere", "radius": 0.1}]}},
    "joints": {"peg": {"kind": "spherical", "b": "bob", "anchor": [0, 1, 0]}}})");
  const auto file = folder / "joints.csv";
  const ProgramRun run =
      tumble_program({"simulate", scene, "--steps", "10", "--joints", file.string()});
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const auto rows = lines_of(read_all(file));
  REQUIRE(rows.size() == 12);
  CHECK(rows[0].starts_with("tick,time_s,joint,kind,body_a,body_b,x,y,z,force_x,"));
  CHECK(rows[1].starts_with("0,0,peg,spherical,world,bob,0,1,0,0,19.6"));
  CHECK(rows[11].starts_with("10,"));
  for (const std::string& row : rows) CHECK(std::count(row.begin(), row.end(), ',') == 29);
}

TEST_CASE("a .json file of contacts holds what each claims at the end") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  for (const char* stepper : {"event", "realtime"}) {
    CAPTURE(stepper);
    const auto file = folder / (std::string(stepper) + ".json");
    REQUIRE(tumble_program({"simulate", scene, "--seconds", "3", "--stepper", stepper, "--contacts",
                            file.string()})
                .code == 0);
    const auto json = nlohmann::json::parse(read_all(file), nullptr, false);
    REQUIRE(json.is_object());
    CHECK(json["stepper"] == stepper);
    REQUIRE(json["contacts"].size() > 0);
    bool pressing = false;
    for (const auto& c : json["contacts"]) {
      pressing |= c["force_on_b"][1].get<double>() > 0;
      CHECK(c["place_in_cone"].get<double>() <= 1 + 1e-6);
    }
    CHECK(pressing);
    for (const auto& b : json["bodies"]) CHECK(b["residual"].get<double>() < 1e-9);
  }
}

TEST_CASE("the JSON summary is one object and nothing else") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const ProgramRun run = tumble_program({"simulate", scene, "--steps", "10", "--json"});
  REQUIRE(run.code == 0);
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  REQUIRE(json.is_object());
  CHECK(json["ticks"] == 10);
  CHECK(is_hash(json["state_hash"].get<std::string>()));
}

TEST_CASE("Ctrl-C and SIGTERM end a long run with 130 and 143 and whole files") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, {SIGTERM, 143}}) {
    const auto csv = folder / "long.csv";
    ProgramOptions options;
    // Its temporary file shows that it has begun.
    options.signal_when = [&, s = signal] { return files_of(folder.path()).size() > 1 ? s : 0; };
    const ProgramRun run =
        tumble_program({"simulate", scene, "--seconds", "100000", "--csv", csv.string()}, options);
    CHECK(run.code == code);
    CHECK(files_of(folder.path()) == std::vector<std::string>{"long.csv", "s.json"});
    CHECK(read_all(csv).ends_with("\n"));
    std::filesystem::remove(csv);
  }
}

TEST_CASE("an interrupted run says where, and its replay and contacts end there") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const std::string csv = (folder / "long.csv").string(), replay = (folder / "run.bin").string(),
                    contacts = (folder / "contacts.json").string();
  ProgramOptions options;
  options.signal_when = [&] { return files_of(folder.path()).size() > 1 ? SIGTERM : 0; };
  const ProgramRun run = tumble_program({"simulate", scene, "--seconds", "100000", "--csv", csv,
                                         "--replay", replay, "--contacts", contacts},
                                        options);
  CHECK(run.code == 143);
  const std::string said = "stopped at tick ";
  REQUIRE_MESSAGE(mentions(run.err, said), run.err);
  const int tick = std::stoi(run.err.substr(run.err.find(said) + said.size()));
  CHECK(nlohmann::json::parse(read_all(contacts)).is_object());
  const ProgramRun again = tumble_program({"simulate", scene, "--play", replay, "--json"});
  CHECK_MESSAGE(again.code == 0, again.err);
  CHECK(nlohmann::json::parse(again.out)["ticks"] == tick);
}

TEST_CASE("a run that breaks down leaves the replay that leads there") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const std::string replay = (folder / "run.bin").string();
  const std::vector<std::string> line = {"simulate", scene,   "--steps",
                                         "50",       "--set", "settings.gravity=[1e9,-1e9,0]"};
  auto recorded = line;
  recorded.insert(recorded.end(), {"--replay", replay});
  const ProgramRun run = tumble_program(recorded);
  CHECK(run.code == 6);
  REQUIRE(std::filesystem::exists(replay));
  CHECK_MESSAGE(mentions(run.err, "run.bin"), run.err);
  auto played = line;
  played.insert(played.end(), {"--play", replay});
  CHECK(tumble_program(played).code == 6);
}

TEST_CASE("how long a run is to be is asked only of scenes that are there, and once") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const ProgramRun both = tumble_program({"simulate", scene, "--steps", "5", "--seconds", "2"});
  CHECK(both.code == 2);
  CHECK_MESSAGE(mentions(both.err, "--seconds and --steps"), both.err);
  const ProgramRun misspelt = tumble_program({"simulate", "towr"});
  CHECK(misspelt.code == 3);
  CHECK_MESSAGE(mentions(misspelt.err, "tower"), misspelt.err);
  const ProgramRun exponent = tumble_program({"simulate", scene, "--seconds", "5e-1", "--json"});
  CHECK(exponent.code == 0);
  CHECK(nlohmann::json::parse(exponent.out)["ticks"] == 30);
}

TEST_CASE("--convergence ends with Ctrl-C within its first run") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  ProgramOptions options;
  const auto begun = std::chrono::steady_clock::now();
  options.signal_when = [&] {
    return std::chrono::steady_clock::now() - begun > std::chrono::milliseconds(400) ? SIGINT : 0;
  };
  const ProgramRun run =
      tumble_program({"simulate", scene, "--seconds", "100000", "--convergence"}, options);
  CHECK(run.code == 130);
  CHECK(run.out.empty());
}

TEST_CASE("scenes and mesh answer in text and JSON") {
  const ProgramRun scenes = tumble_program({"scenes", "--json"});
  CHECK(scenes.code == 0);
  CHECK(nlohmann::json::parse(scenes.out, nullptr, false)["scenes"].is_array());

  TempFolder folder;
  const std::string cube = write_text(folder / "tetra.obj",
                                      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                      "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const ProgramRun mesh = tumble_program({"mesh", cube, "--json"});
  REQUIRE(mesh.code == 0);
  const auto json = nlohmann::json::parse(mesh.out, nullptr, false);
  CHECK(json["triangles"] == 4);
  CHECK(json["closed"] == true);
  CHECK(json["volume"].get<double>() == doctest::Approx(1.0 / 6));
  CHECK(json["centre"][1].get<double>() == doctest::Approx(0.25));
  const std::string open = write_text(folder / "open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const ProgramRun sheet = tumble_program({"mesh", open, "--json"});
  CHECK(sheet.code == 0);
  CHECK(nlohmann::json::parse(sheet.out, nullptr, false)["closed"] == false);
}

namespace {

/// The small scene with sensors and assertions.
std::string sensed_scene(const std::string& assertions) {
  std::string text = small_scene();
  text.insert(text.rfind('}'), R"(, "sensors": {
    "low": {"type": "gate", "radius": 2, "position": [0, 0.5, 0]},
    "all": {"type": "region", "size": [9, 9, 9]},
    "thud": {"type": "contact", "a": "ball"}
  }, "parameters": {"n": 4}, "assertions": )" +
                                   assertions);
  return text;
}

}  // namespace

TEST_CASE("sensors are known to --assert and --csv") {
  const TempFolder folder;
  const std::string scene = write_text(folder / "s.json", sensed_scene("[]"));
  const std::string csv = (folder / "s.csv").string();
  CHECK(tumble_program({"simulate", scene, "--seconds", "3", "--csv", csv, "--assert",
                        "sensors.low.backward == 2 && sensors.low.count == 2", "--assert",
                        "sensors.all.count == 4 && sensors.all.holds.ball == 1", "--assert",
                        "sensors.thud.touching == 1 && sensors.thud.force > 1"})
            .code == 0);
  std::ifstream file(csv);
  std::string header, line, last;
  std::getline(file, header);
  while (std::getline(file, line)) last = line;
  CHECK(mentions(header, ",sensors.low.count,sensors.low.forward,"));
  CHECK(mentions(header, ",sensors.thud.force,"));
  CHECK(std::ranges::count(header, ',') == std::ranges::count(last, ','));
  const ProgramRun run =
      tumble_program({"simulate", scene, "--seconds", "1", "--assert", "sensors.low.cuont == 2"});
  CHECK(run.code == 2);
  CHECK(mentions(run.err, "did you mean 'sensors.low.count'"));
}

TEST_CASE("assertions of a scene: at a moment, always, at the end, one that fails ends with 1") {
  const TempFolder folder;
  const auto run = [&](const std::string& assertions, const char* seconds) {
    const std::string scene = write_text(folder / "a.json", sensed_scene(assertions));
    return tumble_program({"simulate", scene, "--seconds", seconds});
  };
  CHECK(run(R"(["bodies == 2 + n - 1", {"holds": "bodies.ball.position.y > 0.9", "at": 0.1},
                {"holds": "bodies.ball.position.y > 0.2", "always": true}])",
            "2")
            .code == 0);
  ProgramRun bad = run(
      R"([{"title": "the ball stays up", "holds": "bodies.ball.position.y > 0.9", "at": 1}])", "2");
  CHECK(bad.code == 1);
  CHECK(mentions(bad.err, "failed after 1 s: the ball stays up"));
  CHECK(mentions(bad.err, "bodies.ball.position.y = "));
  bad = run(R"([{"holds": "bodies.ball.position.y > 0.9", "always": true, "at": 0}])", "2");
  CHECK(bad.code == 1);
  CHECK(run(R"(["bodies.ball.position.y > 0.9"])", "0.1").code == 0);
  CHECK(run(R"(["bodies.ball.position.y > 0.9"])", "1").code == 1);
  const ProgramRun early = run(R"([{"holds": "time > 5", "at": 4}])", "1");
  CHECK(early.code == 0);
  CHECK(mentions(early.err, "not reached (at 4 s): time > 5"));
  bad = run(R"(["bodies.ball.position.y > 0.9",
 {"holds": "sensors.low.cuont == 2"}])",
            "1");
  CHECK(bad.code == 3);
  CHECK(mentions(bad.err, "assertions[1].holds: unknown quantity 'sensors.low.cuont'"));
  CHECK(run(R"(["time"])", "1").code == 3);
}

TEST_CASE("check --run runs a scene until its assertions are decided") {
  const TempFolder folder;
  const auto check = [&](const std::string& assertions) {
    const std::string scene = write_text(folder / "a.json", sensed_scene(assertions));
    return tumble_program({"check", scene, "--run"}).code;
  };
  CHECK(check(R"([{"holds": "abs(time - 0.5) < 1e-9", "at": 0.5}, "abs(time - 0.5) < 0.02"])") ==
        0);
  CHECK(check(R"([{"holds": "time > 0.6", "at": 0.5}])") == 1);
  CHECK(check("[]") == 0);
  // Nothing says when to end.
  CHECK(check(R"([{"holds": "time < 9.9", "always": true}])") == 1);
  CHECK(check(R"([{"holds": "time < 10.1", "always": true}])") == 0);
  CHECK(check(R"(["abs(time - 10) < 0.02"])") == 0);
  CHECK(check(R"([{"holds": "time < 11.9", "always": true, "at": 2}])") == 1);
  CHECK(
      check(
          R"([{"holds": "time < 11.9", "always": true, "at": 2}, {"holds": "time > 1", "at": 1}])") ==
      1);
  CHECK(
      check(
          R"([{"holds": "time < 3.1", "always": true, "at": 2}, {"holds": "time > 1", "at": 3}])") ==
      0);
  const std::string scene =
      write_text(folder / "b.json", sensed_scene(R"([{"holds": "time < 1", "always": true}])"));
  CHECK(mentions(tumble_program({"check", scene, "--run"}).err, "it is run to 10 s"));
  const ProgramRun told = tumble_program({"check", scene, "--run", "--seconds", "0.9"});
  CHECK(told.code == 0);
  CHECK_FALSE(mentions(told.err, "it is run to"));
  // What is not reached is not known to hold.
  for (const char* always : {"", R"(, "always": true)"}) {
    const std::string late = write_text(
        folder / "c.json",
        sensed_scene(std::string(R"(["time > 0", {"holds": "time > 0", "at": 2)") + always + "}]"));
    const auto for_seconds = [&](const char* seconds) {
      return tumble_program({"check", late, "--run", "--seconds", seconds});
    };
    const ProgramRun cut = for_seconds("1");
    CHECK(cut.code == 1);
    CHECK(mentions(cut.err, "the run ended at 1 s, before all assertions were decided"));
    CHECK(mentions(cut.err, "give it 2 or more"));
    CHECK(for_seconds("2").code == 0);
  }
  CHECK(tumble_program({"check", scene, "--seconds", "0.9"}).code == 2);
}
