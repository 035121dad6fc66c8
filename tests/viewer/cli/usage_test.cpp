// Reference: the table of exit codes of the manual; the real program is run as a user would.
#include "tests/viewer/cli/program.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;

TEST_CASE("help and version go to stdout and succeed") {
  for (const auto& arguments : std::vector<std::vector<std::string>>{{"--help"},
                                                                     {"-h"},
                                                                     {"render", "--help"},
                                                                     {"simulate", "-h"},
                                                                     {"compare", "--help"},
                                                                     {"check", "--help"},
                                                                     {"scenes", "--help"},
                                                                     {"mesh", "--help"},
                                                                     {"bench", "--help"},
                                                                     {"open", "--help"}}) {
    const ProgramRun run = tumble_program(arguments);
    CHECK(run.code == 0);
    CHECK(run.out.size() > 100);
    CHECK(run.err.empty());
  }
  const ProgramRun version = tumble_program({"--version"});
  CHECK(version.code == 0);
  CHECK(version.out.starts_with("tumble "));
}

TEST_CASE("the doctor gives 0 where something can draw and 4 where nothing can") {
  const ProgramRun here = tumble_program({"doctor", "--json"});
  const auto told = nlohmann::json::parse(here.out, nullptr, false);
  REQUIRE(told.is_object());
  bool any = false;
  for (const auto& context : told["contexts"]) any = any || context["ok"].get<bool>();
  CHECK(told["usable"] == any);
  CHECK(here.code == (any ? 0 : 4));

  // Nothing is left to draw with: no display, no EGL driver, and no library of the name.
  TempFolder folder;
  write_text(folder / "libOSMesa.so.8", "not a library");
  ProgramOptions nowhere;
  nowhere.environment = {{"__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent"},
                         {"LIBGL_DRIVERS_PATH", "/nonexistent"},
                         {"LD_LIBRARY_PATH", folder.path().string()}};
  const ProgramRun none = tumble_program({"doctor", "--json"}, nowhere);
  const auto failed = nlohmann::json::parse(none.out, nullptr, false);
  REQUIRE(failed.is_object());
  CHECK(failed["usable"] == false);
  CHECK(none.code == 4);
  for (const auto& context : failed["contexts"]) {
    CHECK_FALSE(context["cause"].get<std::string>().empty());
    CHECK_FALSE(context["cure"].get<std::string>().empty());
  }
  CHECK(tumble_program({"doctor"}, nowhere).code == 4);
}

TEST_CASE("every command of the help is there, with a line of its own") {
  const std::string help = tumble_program({"--help"}).out;
  for (const char* name : {"open", "render", "compare", "simulate", "check", "scenes", "mesh",
                           "bench", "verify", "pack", "keys"})
    CHECK_MESSAGE(mentions(help, std::string("\n  ") + name), name);
}

TEST_CASE("bad usage is 2, with a cure on stderr and nothing on stdout") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const std::string out = (folder / "out").string();
  const std::vector<std::vector<std::string>> wrong = {
      {"rendr", "tower"},
      {"nonsense"},
      {"--nonsense"},
      {"render"},
      {"render", scene},
      {"render", scene, "-o", out},
      {"render", scene, "-o", out, "--frames", "1", "--seconds", "1"},
      {"render", scene, "-o", out, "--frames", "-1"},
      {"render", scene, "-o", out, "--frames", "0"},
      {"render", scene, "-o", out, "--frames", "abc"},
      {"render", scene, "-o", out, "--frames", "1e9"},
      {"render", scene, "-o", out, "--frames", "99999999999999999999"},
      {"render", scene, "-o", out, "--seconds", "nan"},
      {"render", scene, "-o", out, "--frames", "1", "--fps", "0"},
      {"render", scene, "-o", out, "--frames", "1", "--fps", "-30"},
      {"render", scene, "-o", out, "--frames", "1", "--size", "0x0"},
      {"render", scene, "-o", out, "--frames", "1", "--size", "1280"},
      {"render", scene, "-o", out, "--frames", "1", "--size", "99999x99999"},
      {"render", scene, "-o", out, "--frames", "1", "--overlay", "nonsense"},
      {"render", scene, "-o", out, "--frames", "1", "--threads", "-3"},
      {"render", scene, "-o", out, "--frames", "1", "--context", "foo"},
      {"mesh", "x.obj", "--render", out + ".png", "--context", "foo"},
      {"simulate", scene},
      {"simulate", scene, "--seconds", "1", "--steps", "2"},
      {"simulate", scene, "--steps", "-2"},
      {"simulate", scene, "--seconds", "1", "--assert", "1 +"},
      {"simulate", scene, "--seconds", "1", "--assert", "bodies.nobody.position.y > 0"},
      {"simulate", scene, "--seconds", "1", "--hash=often"},
      {"simulate", scene, "--seconds", "1", "--set", "bodies.nobody.mass=3"},
      {"simulate", scene, "--seconds", "1", "--set", "nonsense"},
      {"compare", "a.png"},
      {"compare", "a.png", "b.png", "--tolerance", "-1"},
      {"compare", "a.png", "b.png", "--tolerance", "300"},
      {"compare", "a.png", "b.png", "--max-differing", "2"},
      {"compare", "a.png", "b.png", "--max-cluster", "-1"},
      {"mesh"},
      {"mesh", "x.obj", "--up", "w"},
      {"mesh", "x.obj", "--scale", "nan"},
      {"mesh", "x.obj", "--scale", "0"},
      {"mesh", "x.obj", "--decompose", "--pieces", "3.5"},
      {"mesh", "x.obj", "--decompose", "--out", ""},
      {"mesh", "x.obj", "--decompose", "--out", "u.stl"},
      {"mesh", "x.obj", "--sdf", "--slices", ""},
      {"simulate", scene, "--steps", "18446744073709551616"},
      {"simulate", scene, "--steps", "1", "--assert", "!energy"},
      {"simulate", scene, "--steps", "1", "--assert", "energy.drift < 1 && 3"},
      {"bench", "W99"},
      {"bench", "W1", "--steps", "none"},
      {"bench", "W1", "--repeat", "0"},
      {"check"},
      {"scenes", "--nonsense"},
  };
  for (const auto& arguments : wrong) {
    const ProgramRun run = tumble_program(arguments);
    std::string line;
    for (const std::string& a : arguments) line += a + " ";
    CHECK_MESSAGE(run.code == 2, line << "\n" << run.err);
    CHECK_MESSAGE(run.out.empty(), line);
    CHECK_MESSAGE(run.err.starts_with("tumble: "), line);
  }
  CHECK(files_of(folder / "out").empty());
  CHECK(mentions(tumble_program({"rendr"}).err, "render"));
}

TEST_CASE("messages are short, in plain words, and name a file once") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const ProgramRun frames =
      tumble_program({"render", scene, "-o", (folder / "o").string(), "--frames", "-1"});
  CHECK(frames.code == 2);
  CHECK(frames.err.size() < 200);
  CHECK(mentions(tumble_program({"mesh", "x.obj", "--scale", "nan"}).err,
                 "'nan' is not a number from 1e-09 to 1000000000"));
  CHECK(mentions(tumble_program({"mesh", "x.obj", "--up", "w"}).err, "'w' is not one of x, y, z"));
  const ProgramRun assertion =
      tumble_program({"simulate", scene, "--steps", "1", "--assert", "energy.drift"});
  CHECK(assertion.code == 2);
  CHECK(mentions(assertion.err, "compare it"));
  const ProgramRun missing = tumble_program({"check", "nofile.json"});
  CHECK(missing.code == 3);
  CHECK(missing.err.find("nofile.json") == missing.err.rfind("nofile.json"));
  const std::string broken = write_text(folder / "b.json", "{\"tumble_scene\": 1, ");
  const ProgramRun json = tumble_program({"check", broken});
  CHECK(json.code == 3);
  CHECK(mentions(json.err, "not valid JSON"));
  CHECK_FALSE(mentions(json.err, "while parsing"));
  CHECK(mentions(tumble_program({"open", "--help"}).out, "Examples:"));
}

TEST_CASE("a scene or mesh that is missing or bad is 3, with file, line and path") {
  TempFolder folder;
  const std::string out = (folder / "out").string();
  const std::string bad = write_text(folder / "bad.json", R"({
  "tumble_scene": 1,
  "bodies": {
    "ball": {"shape": {"type": "sphere", "radius": -1}},
    "box": {"shap": {"type": "box", "size": [1, 1, 1]}}
  }
})");
  const std::string torn = write_text(folder / "torn.json", small_scene().substr(0, 200));
  const std::string empty = write_text(folder / "empty.json", "");
  for (const std::string& file : {bad, torn, empty, (folder / "missing.json").string()}) {
    CHECK(tumble_program({"check", file}).code == 3);
    CHECK(tumble_program({"simulate", file, "--steps", "1"}).code == 3);
    CHECK(tumble_program({"render", file, "-o", out, "--frames", "1"}).code == 3);
    CHECK(tumble_program({"mesh", file}).code == 3);
  }
  CHECK(files_of(folder / "out").empty());
  const ProgramRun run = tumble_program({"check", bad});
  CHECK(mentions(run.err, "bad.json:4: bodies.ball.shape.radius"));
  CHECK(mentions(run.err, "bad.json:5: bodies.box.shap"));
  CHECK(mentions(run.err, "'shape'"));
  CHECK(tumble_program({"simulate", "no_such_scene", "--steps", "1"}).code == 3);
}

TEST_CASE("check says ok, and its JSON is one object") {
  TempFolder folder;
  const std::string good = write_text(folder / "good.json", small_scene());
  const std::string bad = write_text(folder / "bad.json", "{\"tumble_scene\": 2}");
  const ProgramRun fine = tumble_program({"check", good});
  CHECK(fine.code == 0);
  CHECK(mentions(fine.out, "ok, 5 bodies"));
  const ProgramRun both = tumble_program({"check", good, bad, "--json"});
  CHECK(both.code == 3);
  const auto json = nlohmann::json::parse(both.out, nullptr, false);
  REQUIRE(json.is_object());
  CHECK_FALSE(json["ok"].get<bool>());
  CHECK(json["files"][0]["ok"].get<bool>());
  CHECK(json["files"][1]["faults"][0]["line"] == 1);
}

TEST_CASE("open without a display says so, names render, and is 4") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  for (const auto& arguments : std::vector<std::vector<std::string>>{{"open", scene}, {scene}}) {
    const ProgramRun run = tumble_program(arguments);
    CHECK(run.code == 4);
    CHECK(mentions(run.err, "display"));
    CHECK(mentions(run.err, "tumble render"));
  }
}

TEST_CASE("output that cannot be written is 5") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const std::string file = write_text(folder / "file", "x");
  CHECK(tumble_program({"simulate", scene, "--steps", "3", "--csv", file + "/x.csv"}).code == 5);
  CHECK(tumble_program({"simulate", scene, "--steps", "3", "--csv", "/dev/full"}).code == 5);
  CHECK(tumble_program({"simulate", scene, "--steps", "3", "--trace", "/proc/x"}).code == 5);
  ProgramOptions full;
  full.stdout_to = "/dev/full";
  CHECK(tumble_program({"simulate", scene, "--steps", "3", "--hash"}, full).code == 5);
  for (const std::vector<std::string>& line :
       std::vector<std::vector<std::string>>{{"--help"},
                                             {"render", "--help"},
                                             {"scenes"},
                                             {"scenes", "--json"},
                                             {"check", scene, "--json"},
                                             {"simulate", scene, "--steps", "2000", "--hash=1"}}) {
    CAPTURE(line[0]);
    CHECK(tumble_program(line, full).code == 5);
  }
  const ProgramRun run =
      tumble_program({"render", scene, "-o", file + "/out", "--frames", "1", "--size", "64x48"});
  CHECK(run.code == 5);
  CHECK(mentions(run.err, "file/out"));
}

TEST_CASE("a simulation that breaks down is 6 and names the body") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const ProgramRun run = tumble_program(
      {"simulate", scene, "--steps", "50", "--set", "settings.gravity=[1e9,-1e9,0]", "--hash"});
  CHECK(run.code == 6);
  CHECK(run.out.empty());
  CHECK(mentions(run.err, "body '"));
}

TEST_CASE("a path that cannot be opened is told with its cause") {
  TempFolder folder;
  const std::string loop = (folder / "loop.json").string();
  std::filesystem::create_symlink("loop.json", loop);
  std::filesystem::create_directory(folder / "robots");
  const auto says = [&](const std::vector<std::string>& arguments, int code,
                        const std::string& words) {
    const ProgramRun run = tumble_program(arguments);
    CHECK_MESSAGE(run.code == code, run.err);
    CHECK_MESSAGE(mentions(run.err, words), run.err);
  };
  says({"check", loop}, 3, "Too many levels of symbolic links");
  says({"check", (folder / "robots").string()}, 3, "this is a folder");
  says({"check", "-"}, 3, "standard input");
  const std::string notes = write_text(folder / "notes.json", small_scene());
  says({"simulate", notes, "--play", notes}, 3, "this is no replay");
  says({"simulate", notes, "--play", notes}, 3, "tumble simulate --replay");
  ProgramOptions full;
  full.stdout_to = "/dev/full";
  CHECK(mentions(tumble_program({"scenes"}, full).err, "No space left on device"));
  // Relative names, as they are typed.
  const std::string program = (std::filesystem::path(TUMBLE_BINARY_DIR) / "bin/tumble").string();
  write_text(folder / "-dash.json", small_scene());
  const auto typed = [&](const std::string& file) {
    return run_program("/bin/sh", {"-c", "cd '" + folder.path().string() + "' && '" + program +
                                             "' check " + file + " 2>&1"});
  };
  CHECK(typed("-dash.json").code == 2);
  CHECK_MESSAGE(mentions(typed("-dash.json").out, "./-dash.json"), typed("-dash.json").out);
  CHECK(typed("./-dash.json").code == 0);
  CHECK_MESSAGE(mentions(typed("robots").out, "this is a folder"), typed("robots").out);
}
