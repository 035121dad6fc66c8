// What a command writes destroys nothing that it reads, or that somebody else wrote. Reference: the
// bytes of the files before, and the table of exit codes.
#include "tests/viewer/cli/program.hpp"
#include "tests/viewer/cli/recorded_run.hpp"

#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;

namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

/// A regular tetrahedron.
std::string tetrahedron() {
  return "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
}

/// A folder with a scene that has a mesh, and the links by which its files may be named too.
struct Inputs {
  TempFolder folder;
  std::string mesh = write_text(folder / "m.obj", tetrahedron());
  std::string scene = write_text(folder / "s.json", R"({"tumble_scene": 1,
    "meshes": {"m": {"file": "m.obj"}},
    "bodies": {"stone": {"shape": {"type": "mesh", "mesh": "m"}, "density": 1000}}})");
  std::string soft = (folder / "soft.json").string(), hard = (folder / "hard.json").string();
  std::vector<std::string> before;

  Inputs() {
    fs::create_symlink(scene, soft);
    fs::create_hard_link(scene, hard);
    before = files_of(folder.path());
  }

  /// The command is refused with 2 and all is as it was.
  void kept(const std::vector<std::string>& arguments, const std::string& said) const {
    const std::string old_scene = content_of(scene), old_mesh = content_of(mesh);
    const ProgramRun run = tumble_program(arguments);
    std::string line;
    for (const std::string& a : arguments) line += a + " ";
    CHECK_MESSAGE(run.code == 2, line << "\n" << run.err);
    CHECK_MESSAGE(mentions(run.err, said), line << "\n" << run.err);
    CHECK_MESSAGE(content_of(scene) == old_scene, line);
    CHECK_MESSAGE(content_of(mesh) == old_mesh, line);
    CHECK_MESSAGE(files_of(folder.path()) == before, line);
  }
};

const std::string overwritten = "this file is read, and would be overwritten";

}  // namespace

TEST_CASE("an output that is an input is refused, whatever it is called") {
  const Inputs in;
  for (const char* option : {"--csv", "--trace", "--joints", "--contacts", "--replay"})
    for (const std::string& name : {in.scene, in.soft, in.hard, in.mesh})
      in.kept({"simulate", in.scene, "--steps", "2", option, name, "--force"}, overwritten);
  in.kept({"verify", in.scene, "--seconds", "0.1", "--csv", in.soft}, overwritten);
  in.kept({"verify", in.scene, "--seconds", "0.1", "--csv", in.mesh}, overwritten);
  in.kept({"pack", in.scene, in.scene, "--force"}, overwritten);
  in.kept({"pack", in.scene, in.soft, "--force"}, overwritten);
  in.kept({"pack", in.scene, in.mesh, "--force"}, overwritten);
  in.kept({"mesh", in.mesh, "--decompose", "--out", in.mesh}, overwritten);
  in.kept({"mesh", in.mesh, "--render", in.mesh}, overwritten);
  in.kept({"compare", in.scene, in.mesh, "--diff", in.soft}, overwritten);
  in.kept({"render", in.scene, "--frames", "1", "--video", in.scene, "--force"}, overwritten);
  // A name in the catalogue is no file: an output may be called the same.
  const std::string out = (in.folder / "x.csv").string();
  CHECK(tumble_program({"simulate", in.scene, "--steps", "2", "--csv", out}).code == 0);
}

TEST_CASE("the robot file of a scene is no output either") {
  TempFolder folder;
  const std::string text =
      R"(<robot name="r"><link name="l"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"
         ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)";
  const std::string robot = write_text(folder / "r.urdf", text);
  const std::string scene =
      write_text(folder / "s.json", R"({"tumble_scene": 1, "robots": {"r": {"file": "r.urdf"}}})");
  const ProgramRun run = tumble_program({"simulate", scene, "--steps", "2", "--csv", robot});
  CHECK(run.code == 2);
  CHECK_MESSAGE(mentions(run.err, overwritten), run.err);
  CHECK(content_of(robot) == text);
}

TEST_CASE("two outputs of one name are refused before the run") {
  const Inputs in;
  const std::string same = (in.folder / "same").string();
  const std::string round = (in.folder / "." / "same").string() + "/";
  in.kept({"simulate", in.scene, "--steps", "2", "--csv", same, "--joints", same},
          "--csv and --joints would both write this");
  in.kept({"simulate", in.scene, "--steps", "2", "--states", same, "--csv", round},
          "would both write this");
  in.kept({"bench", "W1", "--json=" + same, "--trace", same}, "would both write this");
  // A device loses nothing.
  CHECK(tumble_program(
            {"simulate", in.scene, "--steps", "2", "--csv", "/dev/null", "--joints", "/dev/null"})
            .code == 0);
}

TEST_CASE("an empty name is none, and not a file that nobody asked for") {
  const Inputs in;
  for (const char* option : {"--csv", "--trace", "--joints", "--contacts", "--replay", "--play",
                             "--export", "--states", "--seconds"})
    in.kept({"simulate", in.scene, "--steps", "2", option, ""}, std::string(option) + ": is empty");
  in.kept({"verify", in.scene, "--csv", ""}, "--csv: is empty");
  in.kept({"compare", in.scene, in.scene, "--diff", ""}, "--diff: is empty");
  in.kept({"mesh", in.mesh, "--render", ""}, "--render: is empty");
  in.kept({"pack", in.scene, "x.tumble", "--replay", ""}, "--replay: is empty");
  in.kept({"render", in.scene, "--frames", "1", "-o", ""}, "is empty");
  in.kept({"render", in.scene, "--frames", "1", "--video", ""}, "--video: is empty");
  in.kept({"render", in.scene, "-o", "x", "--states", ""}, "--states: is empty");
  in.kept({"bench", "W1", "--trace", ""}, "--trace: is empty");
}

TEST_CASE("a link stays a link, and what it leads to is written") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  fs::create_directories(folder / "far");
  write_text(folder / "far/old.csv", "old");
  for (const char* name : {"old", "new"}) {  // `new` is not there yet
    CAPTURE(name);
    const auto link = folder / (std::string(name) + "_link");
    const auto target = fs::path("far") / (std::string(name) + ".csv");
    fs::create_symlink(target, link);
    REQUIRE(tumble_program({"simulate", scene, "--steps", "2", "--csv", link.string()}).code == 0);
    CHECK(fs::is_symlink(fs::symlink_status(link)));
    CHECK(content_of(folder.path() / target).starts_with("tick,"));
  }
  const auto pack = folder / "pack_link";
  fs::create_symlink(folder / "far/s.tumble", pack);
  REQUIRE(tumble_program({"pack", scene, pack.string()}).code == 0);
  CHECK(fs::is_symlink(fs::symlink_status(pack)));
  CHECK(content_of(folder / "far/s.tumble").starts_with("PK"));
  CHECK(files_of(folder / "far") == std::vector<std::string>{"new.csv", "old.csv", "s.tumble"});
}

TEST_CASE("/dev/stdout is what stdout goes to, also where that is a file") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  ProgramOptions options;
  options.stdout_to = write_text(folder / "out", "");
  // By the file's own name, which is the same and risks no device where the test has all rights.
  REQUIRE(tumble_program(
              {"simulate", scene, "--steps", "2", "--hash", "--csv", options.stdout_to.string()},
              options)
              .code == 0);
  const std::string out = content_of(options.stdout_to);
  CHECK(out.starts_with("tick,"));
  CHECK(out.size() > out.rfind('\n', out.size() - 2) + 16);
  CHECK(out.substr(out.rfind('\n', out.size() - 2) + 1).size() == 17);  // the hash, and its newline
}

TEST_CASE("a pack is written to files only, and takes no file of the user for its own") {
  TempFolder folder;
  ProgramOptions home;
  home.environment = {{"XDG_CACHE_HOME", (folder / "cache").string()}};
  const std::string scene = write_text(folder / "s.json", small_scene());
  const std::string pack = (folder / "s.tumble").string();
  const std::string mine = write_text(folder / "s.tumble.part", "mine");
  REQUIRE(tumble_program({"pack", scene, pack}, home).code == 0);
  CHECK(content_of(mine) == "mine");
  // A pipe stands for all devices.
  const std::string pipe = (folder / "pipe").string();
  REQUIRE(run_program("/usr/bin/mkfifo", {pipe}).code == 0);
  const ProgramRun run = tumble_program({"pack", scene, pipe, "--force"}, home);
  CHECK(run.code == 5);
  CHECK_MESSAGE(mentions(run.err, "a pack is a file"), run.err);
  CHECK(fs::is_fifo(pipe));
  const ProgramRun nowhere = tumble_program({"pack", scene, (folder / "no/s.tumble").string()});
  CHECK(nowhere.code == 5);
  CHECK_MESSAGE(mentions(nowhere.err, "No such file or directory"), nowhere.err);
}

TEST_CASE("a pack that is packed again keeps its replay") {
  TempFolder folder;
  ProgramOptions home;
  home.environment = {{"XDG_CACHE_HOME", (folder / "cache").string()}};
  const std::string scene = write_text(folder / "s.json", small_scene());
  const std::string replay = (folder / "run.bin").string(), a = (folder / "a.tumble").string(),
                    b = (folder / "b.tumble").string(), c = (folder / "c.tumble").string();
  const std::string hash = record(scene, replay, 2) + "\n";
  REQUIRE(tumble_program({"pack", scene, a, "--replay", replay}, home).code == 0);
  REQUIRE(tumble_program({"pack", a, b}, home).code == 0);
  CHECK(content_of(b) == content_of(a));
  CHECK(tumble_program({"simulate", b, "--hash"}, home).out == hash);
  REQUIRE(tumble_program({"pack", a, c, "--no-replay"}, home).code == 0);
  CHECK(tumble_program({"simulate", c, "--hash"}, home).code == 2);  // how long?
}
