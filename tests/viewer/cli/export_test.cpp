// Reference: the same scene stepped in this test, bit for bit; the files are read by small readers
// of their own (PLY by its header, VTU as XML with base64 by hand).
#include "engine/world/world.hpp"
#include "tests/viewer/cli/exported_files.hpp"
#include "tests/viewer/cli/program.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/capture/particles/export_list.hpp"

#include <csignal>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;
using namespace tumble::exported;

namespace {

/// Drops from two emitters, one of which makes a system that nothing else is in.
std::string drops_scene() {
  return R"({
  "tumble_scene": 1,
  "bodies": {"floor": {"type": "static", "shape": {"type": "half_space"}}},
  "particles": {
    "water": {"mass": 0.002, "radius": 0.03, "fast": true},
    "red_dust": {"mass": 0.001, "radius": 0.02, "fast": true, "colour": "#ff0000"}},
  "emitters": {
    "tap": {"particles": "water", "position": [0, 1, 0], "rate": 300, "speed": 2, "spread_deg": 20,
            "life": {"mean": 0.5, "spread": 0.2}, "colour_over_life": ["#ffffff", "#204080"]},
    "vent": {"particles": "red_dust", "position": [1, 1, 0], "rate": 40, "start": 0.25,
             "speed": 1, "spread_deg": 60, "count": 200}}
})";
}

struct Export {
  TempFolder folder;
  std::string scene = write_text(folder / "drops.json", drops_scene());

  std::filesystem::path out(const std::string& name) const { return folder / name; }
  ProgramRun operator()(const std::string& name, std::vector<std::string> more,
                        const ProgramOptions& options = {}) const {
    std::vector<std::string> all = {"simulate", scene, "--export", out(name).string()};
    all.insert(all.end(), more.begin(), more.end());
    return tumble_program(all, options);
  }
  /// The world of the scene after so many ticks.
  std::unique_ptr<World> world(int ticks) const {
    SceneRequest request;
    request.scene = scene;
    request.threads = 1;
    auto loaded = load_scene_and_world(request);
    REQUIRE(loaded.ok());
    for (int i = 0; i < ticks; ++i) REQUIRE(loaded->built.world->step().ok());
    return std::move(loaded->built.world);
  }
  std::map<std::string, std::string> contents(const std::string& name) const {
    std::map<std::string, std::string> all;
    for (const std::string& file : files_of(out(name))) all[file] = file_text(out(name) / file);
    return all;
  }
};

const ParticleSystem& system_of(const World& world, const std::string& name) {
  const auto frame = world.frame();
  for (const auto& system : frame->particles)
    if (system->name == name) return *world.particles(system->id);
  FAIL("no system ", name);
  std::abort();
}

/// Numbers of a system in the order that a file has them.
std::vector<double> flat(const std::vector<Vec3>& vectors) {
  std::vector<double> out;
  for (const Vec3& v : vectors) out.insert(out.end(), v.data(), v.data() + 3);
  return out;
}

}  // namespace

TEST_CASE("PLY files have every particle of the world, to the last bit") {
  const Export exported;
  REQUIRE(exported("a", {"--seconds", "1"}).code == 0);
  const auto world = exported.world(44);
  for (const std::string name : {"water", "red_dust"}) {
    CAPTURE(name);
    const ParticleSystem& p = system_of(*world, name);
    REQUIRE(p.size() > 10);
    const PlyFile ply = read_ply(exported.out("a") / (name + "_000022.ply"));
    REQUIRE(ply.good);
    REQUIRE(ply.vertices == p.size());
    CHECK(mentions(ply.header, fmt_time(44.0 / 60)));
    const auto x = flat(p.x), v = flat(p.v);
    for (size_t k = 0; k < 3; ++k)
      for (size_t i = 0; i < p.size(); ++i) {
        CHECK(ply.columns.at(std::string(1, "xyz"[k]))[i] == x[3 * i + k]);
        CHECK(ply.columns.at(std::string("v") + "xyz"[k])[i] == v[3 * i + k]);
      }
    CHECK(ply.columns.at("radius") == p.radius);
    CHECK(ply.columns.at("mass") == p.mass);
    CHECK(ply.columns.at("age") == p.age);
    CHECK(ply.columns.at("id") == std::vector<double>(p.id.begin(), p.id.end()));
  }
  const PlyFile dust = read_ply(exported.out("a") / "red_dust_000029.ply");
  CHECK(dust.columns.at("red") == std::vector<double>(dust.vertices, 255));
  CHECK(dust.columns.at("green") == std::vector<double>(dust.vertices, 0));
  CHECK(read_ply(exported.out("a") / "red_dust_000000.ply").vertices == 0);
}

TEST_CASE("VTU files are XML with every particle, to the last bit, and the PVD has their times") {
  const Export exported;
  REQUIRE(exported("a", {"--seconds", "1", "--format", "vtu", "--fps", "20"}).code == 0);
  const auto world = exported.world(45);
  const ParticleSystem& p = system_of(*world, "water");
  const VtuFile vtu = read_vtu(exported.out("a") / "water_000015.vtu");
  REQUIRE_MESSAGE(vtu.fault.empty(), vtu.fault);
  CHECK(vtu.points == p.size());
  CHECK(vtu.cells == p.size());
  CHECK(vtu.array<double>("Points") == flat(p.x));
  CHECK(vtu.array<double>("velocity") == flat(p.v));
  CHECK(vtu.array<double>("radius") == p.radius);
  CHECK(vtu.array<double>("mass") == p.mass);
  CHECK(vtu.array<double>("age") == p.age);
  CHECK(vtu.array<uint64_t>("id") == p.id);
  CHECK(vtu.array<uint8_t>("types") == std::vector<uint8_t>(p.size(), 1));
  const auto colour = vtu.array<float>("colour");
  REQUIRE(colour.size() == 3 * p.size());
  for (size_t i = 0; i < colour.size(); ++i) CHECK(colour[i] == p.colour[i / 3][int(i % 3)]);
  const auto ends = vtu.array<int64_t>("offsets");
  for (size_t i = 0; i < ends.size(); ++i) CHECK(ends[i] == int64_t(i) + 1);
  for (const std::string& file : files_of(exported.out("a")))
    if (file.ends_with(".vtu")) CHECK(read_vtu(exported.out("a") / file).fault.empty());

  const XmlNode pvd = read_xml(file_text(exported.out("a") / "water.pvd"));
  const auto sets = pvd.all("DataSet");
  REQUIRE(sets.size() == 20);
  for (size_t k = 0; k < sets.size(); ++k) {
    CHECK(std::stod(sets[k]->attributes.at("timestep")) == double(k) / 20);
    CHECK(std::filesystem::exists(exported.out("a") / sets[k]->attributes.at("file")));
  }
}

TEST_CASE("a frame between two ticks is interpolated particle by particle") {
  const Export exported;
  REQUIRE(exported("a", {"--seconds", "0.6", "--fps", "100"}).code == 0);
  const auto before = exported.world(31), after = exported.world(32);
  const ParticleSystem &from = system_of(*before, "water"), &to = system_of(*after, "water");
  // 0.52 s are 31.2 ticks.
  const PlyFile ply = read_ply(exported.out("a") / "water_000052.ply");
  REQUIRE(ply.vertices == to.size());
  size_t known = 0;
  for (size_t i = 0; i < to.size(); ++i) {
    const size_t k = from.find(to.id[i]);
    const bool there = k < from.size();
    known += there;
    const double x = there ? from.x[k].y() + 0.2 * (to.x[i].y() - from.x[k].y()) : to.x[i].y();
    CHECK(ply.columns.at("y")[i] == doctest::Approx(x).epsilon(1e-14));
    const double age = there ? from.age[k] + 0.2 * (to.age[i] - from.age[k]) : to.age[i];
    CHECK(ply.columns.at("age")[i] == doctest::Approx(age).epsilon(1e-12));
  }
  CHECK(known > 10);
  CHECK(known < to.size());
}

TEST_CASE("existing files are 5 and stay, --force writes them anew without leftovers") {
  const Export exported;
  REQUIRE(exported("a", {"--seconds", "1"}).code == 0);
  const auto first = exported.contents("a");
  const ProgramRun again = exported("a", {"--seconds", "0.5"});
  CHECK(again.code == 5);
  CHECK(mentions(again.err, "--resume"));
  CHECK(exported.contents("a") == first);
  write_text(exported.out("a") / "mine.txt", "not ours");
  REQUIRE(exported("a", {"--seconds", "0.5", "--force"}).code == 0);
  CHECK(std::filesystem::exists(exported.out("a") / "mine.txt"));
  CHECK(files_of(exported.out("a")).size() == 2 * 15 + 2);
  CHECK(exported("a", {"--seconds", "0.5", "--resume", "--fps", "10"}).code == 5);
}

TEST_CASE("a killed export is resumed and gives the same files as one that was not") {
  const Export exported;
  for (const std::string format : {"ply", "vtu"}) {
    CAPTURE(format);
    const std::vector<std::string> options = {"--seconds", "4", "--format", format};
    REQUIRE(exported("whole-" + format, options).code == 0);
    const auto whole = exported.contents("whole-" + format);
    ProgramOptions killing;
    const std::string name = "killed-" + format;
    killing.signal_when = [&] { return files_of(exported.out(name)).size() > 40 ? SIGKILL : 0; };
    CHECK(exported(name, options, killing).code == 137);
    write_text(exported.out(name) / (".tumble-part-1-water_000050." + format), "half");
    for (const auto& [file, text] : exported.contents(name))
      if (!file.starts_with(".") && file.ends_with("." + format)) CHECK(text == whole.at(file));
    auto resumed = options;
    resumed.push_back("--resume");
    REQUIRE(exported(name, resumed).code == 0);
    CHECK(exported.contents(name) == whole);
  }
}

TEST_CASE("after Ctrl-C the list tells of what is there, and whole frames are not written again") {
  const Export exported;
  ProgramOptions options;
  options.signal_when = [&] { return files_of(exported.out("a")).size() > 30 ? SIGINT : 0; };
  CHECK(exported("a", {"--seconds", "4000"}, options).code == 130);
  const auto list = nlohmann::json::parse(file_text(exported.out("a") / "particles.json"));
  const size_t frames = list["frames"].size();
  CHECK(files_of(exported.out("a")).size() == 2 * frames + 1);
  CHECK(list["complete"] == false);
  const auto broken = exported.out("a") / export_name("water", frames - 2);
  const std::string good = file_text(broken);
  write_text(broken, "cut short");
  const ProgramRun run = exported("a", {"--seconds", "8", "--resume"});
  REQUIRE(run.code == 0);
  CHECK(mentions(run.err, std::to_string(frames - 2) + " of them there before"));
  CHECK(file_text(broken) == good);
}

TEST_CASE("a resumed export whose state differs is refused as diverged") {
  const Export exported;
  REQUIRE(exported("a", {"--seconds", "0.2"}).code == 0);
  const auto file = exported.out("a") / "particles.json";
  auto list = nlohmann::json::parse(file_text(file));
  list["frames"][5]["state_hash"] = "0000000000000000";
  write_text(file, list.dump());
  const auto before = files_of(exported.out("a"));
  CHECK(exported("a", {"--seconds", "1", "--resume"}).code == 1);
  CHECK(files_of(exported.out("a")) == before);
}

TEST_CASE("bad words and scenes without particles are 2, an unwritable folder 5") {
  const Export exported;
  const ProgramRun bad = exported("a", {"--seconds", "1", "--format", "stl"});
  CHECK(bad.code == 2);
  CHECK(mentions(bad.err, "ply"));
  CHECK(exported("a", {"--seconds", "1", "--fps", "-3"}).code == 2);
  CHECK(tumble_program({"simulate", exported.scene, "--seconds", "1", "--resume"}).code == 2);
  const ProgramRun both =
      exported("a", {"--steps", "1", "--states", exported.out("x").string() + "/../a/"});
  CHECK(both.code == 2);
  CHECK(mentions(both.err, "a file or folder for each"));
  CHECK_FALSE(std::filesystem::exists(exported.out("a")));
  const std::string bare = write_text(exported.folder / "bare.json", small_scene());
  const auto to = exported.out("b").string();
  const ProgramRun none = tumble_program({"simulate", bare, "--seconds", "1", "--export", to});
  CHECK(none.code == 2);
  CHECK(mentions(none.err, "no particle"));
  CHECK(exported("drops.json", {"--seconds", "1"}).code == 2);  // the scene itself
  ProgramOptions full;
  full.file_limit = 3000;
  CHECK(exported("c", {"--seconds", "1"}, full).code == 5);
  for (const std::string& name : files_of(exported.out("c")))
    if (name.ends_with(".ply")) CHECK(read_ply(exported.out("c") / name).good);
}

TEST_CASE("surfaces are closed meshes about the particles, and only of those there are") {
  const Export exported;
  REQUIRE(exported("a", {"--seconds", "1", "--fps", "6", "--surface"}).code == 0);
  CHECK(files_of(exported.out("a")).size() == 6 * 2 * 2 + 1);
  CHECK(read_ply(exported.out("a") / "water-surface_000000.ply").faces.empty());
  const PlyFile drops = read_ply(exported.out("a") / "water_000004.ply");
  const PlyFile skin = read_ply(exported.out("a") / "water-surface_000004.ply");
  REQUIRE(skin.good);
  CHECK(skin.faces.size() > 1000);
  const auto point = [](const PlyFile& file, size_t i) {
    return Vec3(file.columns.at("x")[i], file.columns.at("y")[i], file.columns.at("z")[i]);
  };
  for (size_t i = 0; i < skin.vertices; i += 7) {
    double nearest = 1e9;
    for (size_t k = 0; k < drops.vertices; ++k)
      nearest = std::min(nearest, (point(skin, i) - point(drops, k)).norm());
    CHECK(nearest < 0.12);  // within the reach of a drop
  }
  std::map<std::pair<int32_t, int32_t>, int> sides;
  double volume = 0;
  for (const auto& f : skin.faces) {
    for (size_t k = 0; k < 3; ++k) ++sides[{f[k], f[(k + 1) % 3]}];
    volume +=
        point(skin, size_t(f[0])).dot(point(skin, size_t(f[1])).cross(point(skin, size_t(f[2]))));
  }
  CHECK(volume > 0);
  for (const auto& [side, count] : sides) CHECK(count == sides[{side.second, side.first}]);
  CHECK(exported("b", {"--seconds", "1", "--surface=big"}).code == 2);
  const ProgramRun fine = exported("c", {"--seconds", "1", "--surface=0.0001"});
  CHECK(fine.code == 5);
  CHECK(mentions(fine.err, "--surface=METRES"));
  CHECK(exported("a", {"--seconds", "1", "--fps", "6", "--resume"}).code == 5);
  CHECK(exported("a", {"--seconds", "1", "--fps", "6", "--surface", "--resume"}).code == 0);
}

TEST_CASE("names in file names are plain and all different") {
  CHECK(file_stems({"water", "red dust/1", "red dust:1", "", "../up", "water"}) ==
        std::vector<std::string>{"water", "red_dust_1", "red_dust_1-2", "particles", "_._up",
                                 "water-2"});
}
