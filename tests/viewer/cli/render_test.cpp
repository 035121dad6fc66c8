// Reference: the pictures of another run, context or camera; names, numbers and times as the manual
// gives them. Needs a renderer (EGL or OSMesa).
#include "engine/core/hash.hpp"
#include "tests/viewer/cli/program.hpp"
#include "tests/viewer/cli/recorded_run.hpp"
#include "viewer/capture/compare.hpp"
#include "viewer/capture/folder_lock.hpp"
#include "viewer/capture/frames_file.hpp"
#include "viewer/capture/png.hpp"

#include <cmath>
#include <csignal>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;

namespace {

struct Render {
  TempFolder folder;
  std::string scene = write_text(folder / "s.json", small_scene());

  std::filesystem::path out(const std::string& name) const { return folder / name; }
  ProgramRun operator()(const std::string& name, std::vector<std::string> more,
                        const ProgramOptions& options = {}) const {
    std::vector<std::string> arguments = {"render",           scene,    "-o",
                                          out(name).string(), "--size", "96x64"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return tumble_program(arguments, options);
  }
  nlohmann::json list(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(out(name) / "frames.json").rdbuf();
    return nlohmann::json::parse(text.str(), nullptr, false);
  }
};

std::vector<std::string> expected_files(uint64_t frames) {
  std::vector<std::string> names;
  for (uint64_t k = 0; k < frames; ++k) names.push_back(frame_name(k));
  names.push_back("frames.json");
  return names;
}

uint64_t hash_of(const std::filesystem::path& file) {
  const auto image = read_image(file);
  REQUIRE(image.ok());
  return image_hash(*image);
}

}  // namespace

TEST_CASE("a sequence has exactly its frames, and frames.json tells of them") {
  Render render;
  const ProgramRun run = render("a", {"--seconds", "0.5", "--fps", "25"});
  REQUIRE_MESSAGE(run.code == 0, run.err);
  CHECK(run.out.empty());
  CHECK(files_of(render.out("a")) == expected_files(13));  // round(12.5)
  const auto list = render.list("a");
  REQUIRE(list.is_object());
  CHECK(list["complete"] == true);
  CHECK(list["frames"].size() == 13);
  CHECK(list["frames"][0]["tick"] == 0);
  CHECK(list["frames"][1]["between_ticks"] == nlohmann::json({2, 3}));  // 60/25 = 2.4
  CHECK(list["frames"][1]["part"] == "2/5");
  CHECK(list["frames"][5]["tick"] == 12);
  CHECK(list["frames"][5]["time"].get<double>() == doctest::Approx(0.2));
  CHECK(list["camera"]["name"] == "main");
  CHECK(mentions(list["ffmpeg"].get<std::string>(), "-framerate 25"));
  CHECK_FALSE(list["renderer"].get<std::string>().empty());
  CHECK(list["times"]["ms_per_frame"]["draw"].get<double>() > 0);
  const auto first = read_image(render.out("a") / frame_name(0));
  REQUIRE(first.ok());
  CHECK(first->width == 96);
  CHECK(first->height == 64);
  CHECK_FALSE(is_uniform(*first));
  CHECK(hash_of(render.out("a") / frame_name(12)) ==
        std::stoull(list["frames"][12]["image_hash"].get<std::string>(), nullptr, 16));
}

TEST_CASE("the same frames again, whatever the threads and the rate") {
  Render render;
  REQUIRE(render("a", {"--frames", "7", "--fps", "30", "--threads", "1"}).code == 0);
  REQUIRE(render("b", {"--frames", "13", "--fps", "60", "--threads", "4"}).code == 0);
  for (uint64_t k = 0; k < 7; ++k)
    CHECK(hash_of(render.out("a") / frame_name(k)) == hash_of(render.out("b") / frame_name(2 * k)));
  CHECK(render.list("a")["frames"][6]["state_hash"] ==
        render.list("b")["frames"][12]["state_hash"]);
}

TEST_CASE("EGL and OSMesa draw the same picture") {
  Render render;
  const ProgramRun egl = render("egl", {"--frames", "2", "--context", "surfaceless"});
  const ProgramRun osmesa = render("osmesa", {"--frames", "2", "--context", "osmesa"});
  REQUIRE_MESSAGE(egl.code == 0, egl.err);
  REQUIRE_MESSAGE(osmesa.code == 0, osmesa.err);
  const auto a = render.list("egl"), b = render.list("osmesa");
  for (size_t k = 0; k < 2; ++k) {
    CHECK(a["frames"][k]["draw_hash"] == b["frames"][k]["draw_hash"]);
    if (a["renderer"] == b["renderer"] && a["gl_version"] == b["gl_version"])
      CHECK(a["frames"][k]["image_hash"] == b["frames"][k]["image_hash"]);
  }
  const auto outcome = compare_paths(render.out("egl"), render.out("osmesa"), {});
  REQUIRE(std::holds_alternative<ComparisonReport>(outcome));
  CHECK(std::get<ComparisonReport>(outcome).equal());
}

TEST_CASE("a draft is another picture of the same state, and standard is what no option gives") {
  Render render;
  for (const std::string quality : {"draft", "standard", "high"}) {
    const ProgramRun run = render(quality, {"--frames", "1", "--quality", quality});
    REQUIRE_MESSAGE(run.code == 0, run.err);
    CHECK(render.list(quality)["frames"][0]["state_hash"] ==
          render.list("draft")["frames"][0]["state_hash"]);
  }
  REQUIRE(render("plain", {"--frames", "1"}).code == 0);
  const auto hash = [&](const std::string& name) {
    return hash_of(render.out(name) / frame_name(0));
  };
  CHECK(hash("standard") == hash("plain"));
  CHECK(hash("draft") != hash("plain"));
  CHECK(hash("high") != hash("plain"));
  // Smooth edges and shadows differ by little from those without: it is the same picture.
  const auto a = read_image(render.out("draft") / frame_name(0));
  const auto b = read_image(render.out("plain") / frame_name(0));
  REQUIRE((a.ok() && b.ok()));
  double sum = 0;
  for (size_t i = 0; i < a->pixels.size(); ++i)
    sum += std::abs(double(a->pixels[i]) - double(b->pixels[i]));
  CHECK(sum / double(a->pixels.size()) < 8);
  const ProgramRun wrong = render("wrong", {"--frames", "1", "--quality", "best"});
  CHECK(wrong.code == 2);
  CHECK(mentions(wrong.err, "draft, standard or high"));
}

TEST_CASE("existing frames are not touched without --resume or --force") {
  Render render;
  REQUIRE(render("a", {"--frames", "3"}).code == 0);
  const auto before = std::filesystem::last_write_time(render.out("a") / frame_name(1));
  const ProgramRun refused = render("a", {"--frames", "3"});
  CHECK(refused.code == 5);
  CHECK(mentions(refused.err, "--resume"));
  CHECK(std::filesystem::last_write_time(render.out("a") / frame_name(1)) == before);
  CHECK(render("a", {"--frames", "3", "--resume"}).code == 0);
  CHECK(std::filesystem::last_write_time(render.out("a") / frame_name(1)) == before);
  CHECK(render("a", {"--frames", "3", "--resume", "--fps", "60"}).code == 5);
  CHECK(render("a", {"--frames", "2", "--force"}).code == 0);
  CHECK(files_of(render.out("a")) == expected_files(2));
}

TEST_CASE("--resume draws again what is cut short or junk, and trusts no folder without its list") {
  Render render;
  REQUIRE(render("a", {"--frames", "4"}).code == 0);
  const auto whole = render.list("a")["frames"];
  for (const char* content : {"", "junk"}) {
    write_text(render.out("a") / frame_name(1), content);
    CHECK(render("a", {"--frames", "4", "--resume"}).code == 0);
    const bool same = render.list("a")["frames"] == whole;
    CHECK(same);
    CHECK(read_image(render.out("a") / frame_name(1)).ok());
  }
  // Another picture in its place: readable, but not the one of the list.
  std::filesystem::copy_file(render.out("a") / frame_name(0), render.out("a") / frame_name(3),
                             std::filesystem::copy_options::overwrite_existing);
  CHECK(render("a", {"--frames", "4", "--resume"}).code == 0);
  const auto image = read_image(render.out("a") / frame_name(3));
  REQUIRE(image.ok());
  CHECK(hash_text(image_hash(*image)) == whole[3]["image_hash"].get<std::string>());

  write_text(render.out("a") / "frames.json", "junk");
  CHECK(render("a", {"--frames", "4", "--resume"}).code == 5);
  std::filesystem::remove(render.out("a") / "frames.json");
  const ProgramRun refused = render("a", {"--frames", "4", "--resume"});
  CHECK(refused.code == 5);
  CHECK(mentions(refused.err, "--force"));
  const ProgramRun first = render("a", {"--frames", "4"});
  CHECK(mentions(first.err, frame_name(0)));
}

TEST_CASE("two runs do not write into one folder: the second is refused with 5") {
  Render render;
  std::filesystem::create_directories(render.out("a"));
  const auto held = FolderLock::take(render.out("a"));
  REQUIRE(held.ok());
  const ProgramRun run = render("a", {"--frames", "1", "--force"});
  CHECK(run.code == 5);
  CHECK(mentions(run.err, "another run"));
  CHECK(files_of(render.out("a")).empty());
}

TEST_CASE("an interrupted run leaves whole files only and is resumed to the same pictures") {
  Render render;
  REQUIRE(render("whole", {"--frames", "60"}).code == 0);
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, {SIGTERM, 143}}) {
    const std::string name = "part" + std::to_string(code);
    ProgramOptions options;
    options.signal_when = [&, s = signal] {
      return files_of(render.out(name)).size() >= 6 ? s : 0;
    };
    const ProgramRun run = render(name, {"--frames", "60"}, options);
    CHECK_MESSAGE(run.code == code, run.err);
    const auto left = files_of(render.out(name));
    REQUIRE(left.size() < 61);
    CHECK(left == expected_files(left.size() - 1));
    CHECK(render.list(name)["complete"] == false);
    CHECK(render.list(name)["frames"].size() == left.size() - 1);

    REQUIRE(render(name, {"--frames", "60", "--resume"}).code == 0);
    CHECK(files_of(render.out(name)) == expected_files(60));
    const bool same = render.list(name)["frames"] == render.list("whole")["frames"];
    CHECK(same);
  }
}

TEST_CASE("after a kill the rest is resumed, and half-written files are gone") {
  Render render;
  ProgramOptions options;
  options.signal_when = [&] { return files_of(render.out("a")).size() >= 6 ? SIGKILL : 0; };
  CHECK(render("a", {"--frames", "60"}, options).code == 137);
  write_text(render.out("a") / ".tumble-part-1-frame_000050.png", "half");
  for (const std::string& file : files_of(render.out("a")))
    if (file.starts_with("frame_") && file.ends_with(".png"))
      CHECK(read_image(render.out("a") / file).ok());
  REQUIRE(render("a", {"--frames", "60", "--resume"}).code == 0);
  CHECK(files_of(render.out("a")) == expected_files(60));
}

TEST_CASE("a resumed run whose state differs is refused as diverged") {
  Render render;
  REQUIRE(render("a", {"--frames", "3"}).code == 0);
  auto list = render.list("a");
  list["frames"][2]["state_hash"] = "0000000000000000";
  write_text(render.out("a") / "frames.json", list.dump());
  const ProgramRun run = render("a", {"--frames", "5", "--resume"});
  CHECK(run.code == 1);
  CHECK(files_of(render.out("a")) == expected_files(3));
}

TEST_CASE("a full disk is 5 with whole files only") {
  Render render;
  ProgramOptions options;
  options.file_limit = 1500;
  const ProgramRun run = render("a", {"--frames", "3"}, options);
  CHECK(run.code == 5);
  for (const std::string& file : files_of(render.out("a"))) CHECK(file == "frames.json");
}

TEST_CASE("no renderer is 4, and says what was tried") {
  Render render;
  ProgramOptions options;
  options.environment = {{"LIBGL_DRIVERS_PATH", "/nonexistent"}};
  const ProgramRun run = render("a", {"--frames", "1", "--context", "surfaceless"}, options);
  CHECK_MESSAGE(run.code == 4, run.err);
  CHECK(render("b", {"--frames", "1", "--context", "window"}).code == 4);
  CHECK(render("c", {"--frames", "1", "--context", "egl:99"}).code == 4);
}

TEST_CASE("cameras, overlays and JSON") {
  Render render;
  const ProgramRun run = render("a", {"--frames", "1", "--camera", "top", "--json"});
  REQUIRE(run.code == 0);
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  REQUIRE(json.is_object());
  CHECK(json["frames"] == 1);
  REQUIRE(render("b", {"--frames", "1"}).code == 0);
  CHECK(hash_of(render.out("a") / frame_name(0)) != hash_of(render.out("b") / frame_name(0)));
  REQUIRE(render("c", {"--frames", "1", "--overlay", "aabbs,collision_shape"}).code == 0);
  CHECK(hash_of(render.out("b") / frame_name(0)) != hash_of(render.out("c") / frame_name(0)));
  const ProgramRun wrong = render("d", {"--frames", "1", "--camera", "tpo"});
  CHECK(wrong.code == 2);
  CHECK(mentions(wrong.err, "'top'"));
}

TEST_CASE(
    "overlays and trails of a scene: on by themselves, off by --overlay, the same after --resume") {
  Render render;
  std::string text = small_scene();
  const std::string look = R"("look": {"overlays": ["aabbs"], "trail": 0.4},)";
  text.insert(text.find("\"bodies\""), look);
  const auto hash = [&](const std::string& name, uint64_t k) {
    return hash_of(render.out(name) / frame_name(k));
  };
  REQUIRE(render("bare", {"--frames", "20"}).code == 0);
  write_text(render.scene, text);
  REQUIRE(render("whole", {"--frames", "20"}).code == 0);
  REQUIRE(render("named", {"--frames", "1", "--overlay", "aabbs"}).code == 0);
  REQUIRE(render("none", {"--frames", "20", "--overlay", "none"}).code == 0);
  CHECK(hash("whole", 0) != hash("bare", 0));
  CHECK(hash("whole", 0) == hash("named", 0));
  CHECK(hash("none", 0) == hash("bare", 0));
  CHECK(hash("none", 12) != hash("bare", 12));  // the trails of what fell

  REQUIRE(render("part", {"--frames", "20"}).code == 0);
  for (uint64_t k = 9; k < 20; ++k) std::filesystem::remove(render.out("part") / frame_name(k));
  REQUIRE(render("part", {"--frames", "20", "--resume"}).code == 0);
  for (uint64_t k = 0; k < 20; ++k) CHECK_MESSAGE(hash("part", k) == hash("whole", k), k);

  text.replace(text.find("\"aabbs\""), 7, "\"boxes\"");
  write_text(render.scene, text);
  const ProgramRun wrong = render("wrong", {"--frames", "1"});
  CHECK(wrong.code == 3);
  CHECK(mentions(wrong.err, "look.overlays[0]"));
}

TEST_CASE("what is enormous, far away or very many is drawn") {
  Render render;
  for (const char* name : {"readme_dust", "stiff_cloth", "big_lever"}) {
    render.scene =
        (std::filesystem::path(TUMBLE_SOURCE_DIR) / "tests/inputs" / name).string() + ".json";
    const ProgramRun run = render(name, {"--frames", "1"});
    REQUIRE_MESSAGE(run.code == 0, run.err);
    const auto picture = read_image(render.out(name) / frame_name(0));
    REQUIRE(picture.ok());
    CHECK_FALSE(is_uniform(*picture));
  }
}

TEST_CASE("a mesh file is a scene: it falls on a table") {
  Render render;
  const std::string mesh = write_text(render.folder / "tetra.obj",
                                      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                      "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const ProgramRun run =
      tumble_program({"simulate", mesh, "--seconds", "2", "--assert",
                      "bodies.mesh.position.y > 0.4 && bodies.mesh.position.y < 0.8"});
  CHECK_MESSAGE(run.code == 0, run.err);
}

TEST_CASE("compare: 0, 1 and 3 for the real program") {
  Render render;
  REQUIRE(render("a", {"--frames", "2"}).code == 0);
  const std::string a = (render.out("a") / frame_name(0)).string();
  CHECK(tumble_program({"compare", a, a}).code == 0);
  REQUIRE(render("b", {"--frames", "1", "--camera", "top"}).code == 0);
  const std::string b = (render.out("b") / frame_name(0)).string();
  const std::string diff = (render.folder / "diff.png").string();
  const ProgramRun run = tumble_program({"compare", a, b, "--diff", diff, "--json"});
  CHECK(run.code == 1);
  CHECK(nlohmann::json::parse(run.out, nullptr, false)["equal"] == false);
  CHECK(read_image(diff).ok());
  CHECK(tumble_program({"compare", a, (render.folder / "s.json").string()}).code == 3);
  CHECK(tumble_program({"compare", a, (render.folder / "missing.png").string()}).code == 3);
  CHECK(tumble_program({"compare", a, b, "--diff", "/proc/diff.png"}).code == 5);
  CHECK(tumble_program({"compare", a, b, "--bless"}).code == 0);
  CHECK(tumble_program({"compare", a, b}).code == 0);
}

TEST_CASE("folders: what differs comes first, an unreadable file is 3 at the end, with a summary") {
  Render render;
  REQUIRE(render("a", {"--frames", "4"}).code == 0);
  std::filesystem::copy(render.out("a"), render.out("b"));
  write_text(render.out("b") / frame_name(1), "junk");
  std::filesystem::remove(render.out("b") / frame_name(3));
  const ProgramRun run =
      tumble_program({"compare", render.out("a").string(), render.out("b").string()});
  CHECK(run.code == 3);
  CHECK(run.out.starts_with(frame_name(1) + ": cannot be read"));
  CHECK(run.out.find(frame_name(3)) < run.out.find(frame_name(0)));
  CHECK(mentions(run.out, "4 pictures: 2 equal, 0 different, 1 missing, 1 unreadable"));
  CHECK(tumble_program({"compare", "/dev/zero", (render.out("a") / frame_name(0)).string()}).code ==
        3);
}

TEST_CASE("a breakdown in the middle of a sequence is 6, what was drawn before stays whole") {
  Render render;
  const ProgramRun run =
      render("a", {"--frames", "9", "--fps", "60", "--set", "settings.gravity=[1e9,-1e9,0]"});
  CHECK(run.code == 6);
  const auto left = files_of(render.out("a"));
  REQUIRE(left.size() >= 2);
  CHECK(left == expected_files(left.size() - 1));
  CHECK(render.list("a")["complete"] == false);
}

TEST_CASE("the replay of a pack is rendered to its end") {
  Render render;
  ProgramOptions home;
  home.environment = {{"XDG_CACHE_HOME", (render.folder / "cache").string()}};
  const auto replay = render.folder / "run.bin";
  const std::string pack = (render.folder / "s.tumble").string();
  const std::string last = record(render.scene, replay, 2);
  REQUIRE(tumble_program({"pack", render.scene, pack, "--replay", replay.string()}, home).code ==
          0);
  render.scene = pack;
  REQUIRE(render("played", {}, home).code == 0);
  // 40 ticks of 1/60 s at 30 pictures a second.
  const auto frames = render.list("played")["frames"];
  REQUIRE(frames.size() == 21);
  CHECK(frames[20]["state_hash"] == last);
  CHECK(render("none", {"--no-replay"}, home).code == 2);
  REQUIRE(render("none", {"--no-replay", "--frames", "21"}, home).code == 0);
  CHECK(render.list("none")["frames"][20]["state_hash"] != last);
}
