// `tumble mesh --decompose` and `--sdf` as a user runs them. References: volumes and sizes known by
// hand, a reader of OBJ files of a dozen lines below, and what is in the folders afterwards.
#include "tests/viewer/cli/program.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <numeric>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string star = std::string(TUMBLE_SOURCE_DIR) + "/assets/meshes/star_prism.obj";
const std::string cup = std::string(TUMBLE_SOURCE_DIR) + "/assets/meshes/cup.obj";

/// An L of 2 x 2 x 1 less a unit cube: volume 3.
std::string l_prism(const fs::path& folder) {
  return write_text(folder / "l.obj",
                    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
                    "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
                    "f 4 3 2 1\nf 6 5 4 1\nf 7 8 9 10\nf 7 10 11 12\n"
                    "f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n");
}

Json json_of(const ProgramRun& run) {
  REQUIRE_MESSAGE(run.code == 0, run.err);
  Json json = Json::parse(run.out, nullptr, false);
  REQUIRE(json.is_object());
  return json;
}

using Point = std::array<double, 3>;

Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// An object of an OBJ file.
struct Part {
  std::vector<Point> vertices;               ///< of its faces, some of them many times
  double volume = 0;                         ///< signed
  std::vector<std::array<Point, 2>> planes;  ///< of its faces, by a point and a unit normal
};

/// What stands before the first object is one too. Planes of faces smaller than `least_area` have
/// no certain normal and are left out.
std::vector<Part> parts_of(const fs::path& file, double least_area) {
  std::ifstream in(file);
  std::vector<Point> v;
  std::vector<Part> out(1);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "o") out.emplace_back();
    if (kind == "v") {
      Point p{};
      words >> p[0] >> p[1] >> p[2];
      v.push_back(p);
    }
    if (kind != "f") continue;
    std::vector<size_t> corners;
    for (std::string word; words >> word;) corners.push_back(std::stoul(word) - 1);
    Part& part = out.back();
    Point area{};
    for (size_t k = 2; k < corners.size(); ++k) {
      const Point &a = v[corners[0]], &b = v[corners[k - 1]], &c = v[corners[k]];
      part.volume += dot(a, cross(b, c)) / 6;
      area = area - cross(c - a, b - a);
    }
    const double size = std::sqrt(dot(area, area));
    if (size > 2 * least_area)
      part.planes.push_back({v[corners[0]], {area[0] / size, area[1] / size, area[2] / size}});
    for (const size_t c : corners) part.vertices.push_back(v[c]);
  }
  if (out[0].planes.empty()) out.erase(out.begin());
  return out;
}

std::vector<double> volumes_of(const fs::path& file) {
  std::vector<double> out;
  for (const Part& part : parts_of(file, 0)) out.push_back(part.volume);
  return out;
}

}  // namespace

TEST_CASE("an L is two boxes, exactly and approximately, in the file as in the answer") {
  const TempFolder folder;
  const std::string file = l_prism(folder.path());
  for (const bool exact : {true, false}) {
    const fs::path out = folder.path() / "pieces.obj";
    std::vector<std::string> arguments = {"mesh",   file,    "--decompose",
                                          "--json", "--out", out.string()};
    if (exact) arguments.push_back("--exact");
    const Json pieces = json_of(tumble_program(arguments))["decomposition"];
    CHECK(pieces["exact"] == exact);
    CHECK(pieces["pieces"].size() == 2);
    CHECK(pieces["bound_met"] == true);
    const std::vector<double> volumes = volumes_of(out);
    REQUIRE(volumes.size() == 2);
    double sum = 0;
    for (const double v : volumes) {
      CHECK(v > 0.9);
      sum += v;
    }
    if (exact) CHECK(sum == doctest::Approx(3).epsilon(1e-12));
    CHECK(pieces["hull_volume"] == doctest::Approx(sum).epsilon(1e-12));
    CHECK(files_of(folder.path()) == std::vector<std::string>{"l.obj", "pieces.obj"});
  }
}

TEST_CASE("pieces as glTF: a node each, read back with the volume of the mesh") {
  // Reference: the program's reader of glTF, which is another library's.
  const TempFolder folder;
  const std::string file = l_prism(folder.path());
  for (const char* name : {"pieces.glb", "pieces.gltf"}) {
    CAPTURE(name);
    const std::string out = (folder.path() / name).string();
    const Json pieces =
        json_of(tumble_program({"mesh", file, "--decompose", "--json", "--out", out}));
    CHECK(pieces["decomposition"]["out"] == out);
    const Json back = json_of(tumble_program({"mesh", out, "--json"}));
    CHECK(back["format"] == "glTF");
    REQUIRE(back["parts"].size() == pieces["decomposition"]["pieces"].size());
    CHECK(back["parts"][0]["name"] == "piece_000");
    double volume = 0;
    for (const Json& shell : back["shells"]) volume += shell["volume"].get<double>();
    CHECK(volume == doctest::Approx(3).epsilon(1e-6));
    CHECK(back["open_edges"] == 0);
  }
}

TEST_CASE("exact pieces of meshes rounded to six digits are convex and add up, in the file") {
  const TempFolder folder;
  const fs::path out = folder.path() / "pieces.obj";
  for (const char* name : {"cup", "marble_curve_right"}) {
    CAPTURE(name);
    const std::string mesh =
        std::string(TUMBLE_SOURCE_DIR) + "/assets/meshes/" + name + std::string(".obj");
    const Json pieces = json_of(tumble_program({"mesh", mesh, "--decompose", "--exact", "--json",
                                                "--out", out.string()}))["decomposition"];
    double sum = 0, far = 0, bulge = 0;
    const std::vector<Part> parts = parts_of(out, 1e-9);
    const std::vector<double> volumes = volumes_of(mesh);  // of the mesh as it stands in its file
    for (const Part& p : parts) {
      sum += p.volume;
      CHECK(p.volume > 0);
      for (const Point& x : p.vertices) {
        far = std::max(far, std::sqrt(dot(x, x)));
        for (const auto& [on, normal] : p.planes) bulge = std::max(bulge, dot(normal, x - on));
      }
    }
    const double whole = std::accumulate(volumes.begin(), volumes.end(), 0.0);
    CHECK(parts.size() > 100);
    CHECK(std::fabs(sum / whole - 1) < 1e-12);
    CHECK(pieces["mesh_volume"] == doctest::Approx(whole).epsilon(1e-12));
    CHECK(pieces["volume_ratio"] == doctest::Approx(1).epsilon(1e-12));
    CHECK(pieces["left_out"]["volume"].get<double>() < 1e-12 * whole);
    CHECK(pieces["left_out"]["parts"].is_number_unsigned());
    CHECK(bulge < 1e-12 * far);
  }
}

TEST_CASE(
    "the text says how many pieces, how far they reach outside, and when a bound is not kept") {
  const ProgramRun good = tumble_program({"mesh", star, "--decompose"});
  CHECK(good.code == 0);
  CHECK(mentions(good.out, "outside the mesh"));
  CHECK(mentions(good.out, "is kept"));
  const ProgramRun few =
      tumble_program({"mesh", star, "--decompose", "--pieces", "1", "--concavity", "1e-4"});
  CHECK(few.code == 0);
  CHECK(mentions(few.out, "NOT kept"));
}

TEST_CASE("a distance field says its cells, bytes and errors, and draws its slices") {
  const TempFolder folder;
  const std::string file = l_prism(folder.path());
  const fs::path slices = folder.path() / "slices";
  const Json field = json_of(tumble_program({"mesh", file, "--sdf", "--cell", "0.05", "--slices",
                                             slices.string(), "--json"}))["distance_field"];
  CHECK(field["cell"] == 0.05);
  CHECK(field["band"] == doctest::Approx(0.1));
  CHECK(field["measured"]["largest"].get<double>() <= field["band_error"].get<double>());
  CHECK(field["overlapped_nodes"] == 0);
  CHECK(field["slices"]["count"] == 24);
  const auto names = files_of(slices);
  REQUIRE(names.size() == 24);
  CHECK(names.front() == "slice_000.png");
  CHECK(names.back() == "slice_023.png");
  const ProgramRun again = tumble_program({"mesh", file, "--sdf", "--slices", slices.string()});
  CHECK(again.code == 5);
  CHECK(mentions(again.err, "--force"));
  CHECK(tumble_program({"mesh", file, "--sdf", "--slices", slices.string(), "--force"}).code == 0);
  const Json by_error =
      json_of(tumble_program({"mesh", file, "--sdf", "--error", "0.05", "--json"}));
  CHECK(by_error["distance_field"]["band_error"].get<double>() <= 0.05);
  CHECK(json_of(tumble_program({"mesh", file, "--json"})).count("distance_field") == 0);
}

TEST_CASE("Ctrl-C leaves all slices of a distance field or none") {
  const TempFolder folder;
  const std::string file = l_prism(folder.path());
  const fs::path slices = folder.path() / "slices";
  const std::vector<std::string> line{"mesh", file,       "--sdf",        "--cell",
                                      "0.01", "--slices", slices.string()};
  ProgramOptions options;
  // When the folder is there, which is before anything is computed, and when a slice is.
  for (const size_t least : {0u, 1u}) {
    options.signal_when = [&] {
      return fs::exists(slices) && files_of(slices).size() >= least ? SIGINT : 0;
    };
    const ProgramRun run = tumble_program(line, options);
    if (least == 0) {
      CHECK(run.code == 130);
      CHECK(run.out.empty());
      CHECK_FALSE(fs::exists(slices));
    } else {
      CHECK(files_of(slices).size() == 24);  // it may have ended before the signal came
    }
  }
}

TEST_CASE(
    "open meshes, options that miss their flag and paths that cannot be written are refused") {
  const TempFolder folder;
  const std::string open = write_text(folder.path() / "open.obj",
                                      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n");
  for (const char* what : {"--decompose", "--sdf"}) {
    const ProgramRun run = tumble_program({"mesh", open, what});
    CHECK(run.code == 3);
    CHECK(mentions(run.err, "open edges"));
    CHECK(run.out.empty());
  }
  CHECK(tumble_program({"mesh", star, "--concavity", "0.1"}).code == 2);
  CHECK(tumble_program({"mesh", star, "--sdf", "--cell", "0.1", "--error", "0.1"}).code == 2);
  CHECK(tumble_program({"mesh", star, "--decompose", "--exact", "--concavity", "0.1"}).code == 2);
  CHECK(tumble_program({"mesh", star, "--decompose", "--out", "/nowhere/at/all.obj"}).code == 5);
  const fs::path never = folder / "never";
  CHECK(
      tumble_program({"mesh", star, "--sdf", "--cell", "1e-7", "--slices", never.string()}).code !=
      0);
  CHECK_FALSE(fs::exists(never));  // a folder that it made for nothing goes again
  const ProgramRun large = tumble_program({"mesh", star, "--sdf", "--cell", "1e-7"});
  CHECK(large.code == 3);
  CHECK(mentions(large.err, "would do"));
}
