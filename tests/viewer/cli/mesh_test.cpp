// `tumble mesh` as a user runs it. References: numbers known by hand (cubes, one triangle, spheres
// with a hole, from a set of models that we did not make), and for our own meshes the integrals of
// signed tetrahedra from a reader of a dozen lines below (1e-6, files being read in single
// precision).
#include "tests/support/assimp_models.hpp"
#include "tests/viewer/cli/program.hpp"

#include <array>
#include <cmath>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

const fs::path assets = fs::path(TUMBLE_SOURCE_DIR) / "assets/meshes";

Json mesh_facts_of(const fs::path& file, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"mesh", file.string(), "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramRun run = tumble_program(arguments);
  CHECK_MESSAGE(run.code == 0, file.string() << ": " << run.err);
  Json json = Json::parse(run.out, nullptr, false);
  REQUIRE_MESSAGE(json.is_object(), file.string());
  return json;
}

using V = std::array<double, 3>;

/// Integrals over the solid: of 1, x_i, and x_i x_j.
struct SolidIntegrals {
  double volume = 0;
  V first{};
  std::array<V, 3> second{};
};

/// Reads only what our own files hold: v and f lines, convex faces.
SolidIntegrals integrate_obj(const fs::path& file) {
  std::ifstream in(file);
  std::vector<V> v;
  SolidIntegrals out;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      V p{};
      words >> p[0] >> p[1] >> p[2];
      v.push_back(p);
    }
    if (kind != "f") continue;
    std::vector<size_t> corners;
    for (std::string word; words >> word;) corners.push_back(std::stoul(word) - 1);
    for (size_t k = 2; k < corners.size(); ++k) {
      const V &a = v[corners[0]], &b = v[corners[k - 1]], &c = v[corners[k]];
      const double d = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                       a[2] * (b[0] * c[1] - b[1] * c[0]);
      out.volume += d / 6;
      for (size_t i = 0; i < 3; ++i) {
        out.first[i] += d / 24 * (a[i] + b[i] + c[i]);
        for (size_t j = 0; j < 3; ++j) {
          const double s = a[i] + b[i] + c[i], t = a[j] + b[j] + c[j];
          out.second[i][j] += d / 120 * (s * t + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
        }
      }
    }
  }
  return out;
}

/// `noise`: of the coordinates in the file, relative.
void check_cube(const fs::path& file, double edge, double noise = 1e-12) {
  CAPTURE(file.string());
  const Json m = mesh_facts_of(file);
  CHECK(m["vertices"] == 8);
  CHECK(m["triangles"] == 12);
  CHECK(m["edges"] == 18);
  CHECK(m["closed"] == true);
  CHECK(m["solid"] == true);
  CHECK(m["euler_characteristic"] == 2);
  CHECK(m["holes"].empty());
  CHECK(m["shells"].size() == 1);
  CHECK(m["area"].get<double>() == doctest::Approx(6 * edge * edge).epsilon(noise));
  CHECK(m["volume"].get<double>() == doctest::Approx(std::pow(edge, 3)).epsilon(noise));
  const Json& mass = m["mass_properties"];
  const double moment = std::pow(edge, 5) / 6;
  for (size_t i = 0; i < 3; ++i) {
    const double middle =
        0.5 * (m["bounds"]["min"][i].get<double>() + m["bounds"]["max"][i].get<double>());
    CHECK(std::abs(mass["centre"][i].get<double>() - middle) < noise * edge);
    CHECK(mass["principal_moments"][i].get<double>() == doctest::Approx(moment).epsilon(noise));
    for (size_t j = 0; j < 3; ++j)
      CHECK(std::abs(mass["inertia"][i][j].get<double>() - (i == j ? moment : 0)) < noise * moment);
  }
  CHECK(m["hull"]["vertices"] == 8);
  if (noise < 1e-9) CHECK(m["hull"]["facets"] == 6);
  CHECK(m["hull"]["volume_ratio"].get<double>() == doctest::Approx(1).epsilon(noise + 1e-9));
  const Json& trees = m["hierarchies"];
  REQUIRE(trees.size() == 4);
  // The root is the cube itself, or the sphere around it: sqrt(3) pi / 2 of its volume.
  for (const char* kind : {"aabb", "obb", "convex_hull"})
    CHECK(trees[kind]["tightness"]["root_over_hull"].get<double>() ==
          doctest::Approx(1).epsilon(1e-5));
  CHECK(trees["sphere"]["tightness"]["root_over_hull"].get<double>() ==
        doctest::Approx(std::sqrt(3.0) * 2 * std::atan(1.0)).epsilon(1e-5));
}

}  // namespace

TEST_CASE("meshes that others made: cubes, open surfaces and a hole") {
  if (!have_assimp_models()) return;
  check_cube(assimp_models / "OBJ/box.obj", 1);
  check_cube(assimp_models / "PLY/cube.ply", 1);
  check_cube(assimp_models / "PLY/cube_binary.ply", 1);
  check_cube(assimp_models / "PLY/cube_uv.ply", 2, 1e-6);
  check_cube(assimp_models / "OFF/Cube.off", 1);
  check_cube(assimp_models / "glTF2/BoxTextured-glTF/BoxTextured.gltf", 1);
  check_cube(assimp_models / "glTF2/BoxTextured-glTF-Binary/BoxTextured.glb", 1);

  const Json hole = mesh_facts_of(assimp_models / "STL/sphereWithHole.stl");
  CHECK(hole["closed"] == false);
  CHECK(hole["solid"] == false);
  CHECK(hole["format"] == "STL");
  CHECK(hole["open_edges"] == 9);
  size_t around = 0;
  for (const Json& h : hole["holes"]) around += h["edges"].get<size_t>();
  CHECK(around == 9);
  CHECK(hole["volume"].is_null());
  CHECK(hole["mass_properties"].is_null());
  CHECK(hole["no_volume_because"].is_string());
  CHECK(hole["hull"]["exists"] == true);
  CHECK(hole["hull"]["volume_ratio"].is_null());

  const Json flat = mesh_facts_of(assimp_models / "STL/triangle.stl");
  CHECK(flat["triangles"] == 1);
  CHECK(flat["area"].get<double>() == doctest::Approx(2).epsilon(1e-12));
  CHECK(flat["hull"]["exists"] == false);
  CHECK(flat["hierarchies"]["obb"]["nodes"] == 1);
  CHECK(flat["hierarchies"]["obb"]["depth"] == 0);
  CHECK(flat["hierarchies"]["sphere"]["tightness"]["root_over_hull"].is_null());
  // The hull of a triangle is itself, seen from both sides.
  CHECK(flat["hierarchies"]["convex_hull"]["tightness"]["leaves_over_mesh"].get<double>() ==
        doctest::Approx(2).epsilon(1e-5));

  const Json spider = mesh_facts_of(assimp_models / "OBJ/spider.obj");
  CHECK(spider["open_edges"] == 72);
  const Json crowded = mesh_facts_of(assimp_models / "OBJ/box_longline.obj");
  CHECK(crowded["non_manifold_edges"] == 4);
  CHECK(crowded["solid"] == false);
}

TEST_CASE("our own meshes: integrals, hulls and trees") {
  for (const char* name : {"trefoil_knot", "gear", "rook", "torus_link", "l_part"}) {
    CAPTURE(name);
    const fs::path file = assets / (std::string(name) + ".obj");
    const SolidIntegrals wanted = integrate_obj(file);
    const Json m = mesh_facts_of(file, {"--density", "2"});
    CHECK(m["format"] == "OBJ");
    CHECK(m["closed"] == true);
    CHECK(m["faults"].empty());
    CHECK(m["volume"].get<double>() == doctest::Approx(wanted.volume).epsilon(1e-6));
    const Json& mass = m["mass_properties"];
    CHECK(mass["mass"].get<double>() == doctest::Approx(2 * wanted.volume).epsilon(1e-6));
    V centre{};
    for (size_t i = 0; i < 3; ++i) {
      centre[i] = wanted.first[i] / wanted.volume;
      CHECK(std::abs(mass["centre"][i].get<double>() - centre[i]) < 1e-7);
    }
    double trace = 0, told = 0;
    std::array<V, 3> about{};
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j)
        about[i][j] = wanted.second[i][j] - wanted.volume * centre[i] * centre[j];
    for (size_t i = 0; i < 3; ++i) trace += about[i][i];
    for (size_t i = 0; i < 3; ++i) {
      told += mass["principal_moments"][i].get<double>();
      for (size_t j = 0; j < 3; ++j)
        CHECK(std::abs(mass["inertia"][i][j].get<double>() -
                       2 * ((i == j ? trace : 0) - about[i][j])) < 1e-6 * trace);
    }
    CHECK(told == doctest::Approx(4 * trace).epsilon(1e-6));
    const double ratio = m["hull"]["volume_ratio"].get<double>();
    CHECK(ratio > 0.02);
    CHECK(ratio < 1);
    const auto triangles = m["triangles"].get<double>();
    for (const auto& [kind, tree] : m["hierarchies"].items()) {
      const auto& shown_kind = kind;
      CAPTURE(shown_kind);
      CHECK(tree["nodes"].get<size_t>() + 1 == 2 * tree["leaves"].get<size_t>());
      CHECK(tree["bytes"].get<double>() ==
            doctest::Approx(tree["bytes_per_triangle"].get<double>() * triangles));
      CHECK(std::exp2(tree["depth"].get<double>()) >= tree["leaves"].get<double>());
      CHECK(tree["tightness"]["root_over_hull"].get<double>() > 0.999);
      CHECK(tree["tightness"]["leaves_over_mesh"].get<double>() > 0.5);
      CHECK(tree["tightness"]["nodes_per_line"].get<double>() > 1);
      CHECK(tree["timing"]["build_ms"].get<double>() >= 0);
    }
    // What volumes are for: tighter ones are met by fewer lines.
    const auto lines = [&](const char* kind) {
      return m["hierarchies"][kind]["tightness"]["nodes_per_line"].get<double>();
    };
    CHECK(lines("convex_hull") < lines("sphere"));
    CHECK(lines("obb") < lines("sphere"));
  }
}

TEST_CASE("scale, up and density do what they say") {
  TempFolder folder;
  const std::string file = write_text(folder / "brick.obj",
                                      "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 3\nv 1 0 3\n"
                                      "v 1 2 3\nv 0 2 3\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\n"
                                      "f 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const Json plain = mesh_facts_of(file);
  CHECK(plain["volume"].get<double>() == doctest::Approx(6).epsilon(1e-14));
  CHECK(plain["bounds"]["size"] == Json({1.0, 2.0, 3.0}));
  const Json scaled = mesh_facts_of(file, {"--scale", "10", "--up", "z", "--density", "0.5"});
  CHECK(scaled["volume"].get<double>() == doctest::Approx(6000).epsilon(1e-14));
  CHECK(scaled["mass_properties"]["mass"].get<double>() == doctest::Approx(3000).epsilon(1e-14));
  CHECK(scaled["bounds"]["size"] == Json({10.0, 30.0, 20.0}));
  // Principal moments of a box, ascending: m (a2 + b2) / 12.
  const Json& moments = plain["mass_properties"]["principal_moments"];
  CHECK(moments[0].get<double>() == doctest::Approx(2.5).epsilon(1e-14));
  CHECK(moments[1].get<double>() == doctest::Approx(5).epsilon(1e-14));
  CHECK(moments[2].get<double>() == doctest::Approx(6.5).epsilon(1e-14));
}

TEST_CASE("clean-up and faults are told") {
  TempFolder folder;
  // Two separate corners at each vertex of a tetrahedron, one face turned over, one without area.
  const std::string file =
      write_text(folder / "torn.obj",
                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                 "f 1 3 2\nf 5 6 8\nf 1 3 4\nf 6 7 8\nf 1 1 2\n");
  const Json m = mesh_facts_of(file);
  CHECK(m["triangles"] == 4);
  CHECK(m["vertices"] == 4);
  CHECK(m["closed"] == true);
  CHECK(m["volume"].get<double>() == doctest::Approx(1.0 / 6).epsilon(1e-14));
  CHECK(m["cleanup"]["changed"] == true);
  CHECK(m["cleanup"]["welded_vertices"].get<size_t>() >= 4);
  CHECK(m["cleanup"]["flipped_triangles"] == 1);
  const std::string text = tumble_program({"mesh", file}).out;
  CHECK(mentions(text, "welded"));
  CHECK(mentions(text, "convex_hull"));
  CHECK(mentions(text, "principal"));

  // Two cubes pushed into each other: closed, but not one solid.
  std::string two;
  for (const double x : {0.0, 0.5})
    for (int k = 0; k < 8; ++k) {
      std::ostringstream line;
      line << "v " << x + (k & 1) << " " << 0.5 * x + ((k >> 1) & 1) << " " << 0.25 * x + (k >> 2)
           << "\n";
      two += line.str();
    }
  for (const int o : {1, 9})
    for (const std::array<int, 4>& q : {std::array{0, 2, 3, 1},
                                        {4, 5, 7, 6},
                                        {0, 1, 5, 4},
                                        {2, 6, 7, 3},
                                        {0, 4, 6, 2},
                                        {1, 3, 7, 5}}) {
      two += "f";
      for (const int v : q) {
        two += ' ';
        two += std::to_string(v + o);
      }
      two += "\n";
    }
  const Json crossed = mesh_facts_of(write_text(folder / "two.obj", two));
  CHECK(crossed["closed"] == true);
  CHECK(crossed["solid"] == false);
  CHECK(crossed["shells"].size() == 2);
  CHECK(crossed["volume"].is_null());
  bool told = false;
  for (const Json& fault : crossed["faults"])
    if (fault["kind"] == "self_intersection") told = fault["count"].get<size_t>() > 0;
  CHECK(told);
}

TEST_CASE("an open mesh is wrapped when asked, and has volume, pieces and a field then") {
  TempFolder folder;
  // A tray of 1 m without a lid, and a sheet that passes through its wall.
  const std::string tray =
      write_text(folder / "tray.obj",
                 "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 .4 0\nv 1 .4 0\nv 1 .4 1\nv 0 .4 1\n"
                 "v .5 .2 .5\nv 1.2 .2 .5\nv 1.2 .2 .7\n"
                 "f 1 2 3 4\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\nf 9 10 11\n");
  const Json open = mesh_facts_of(tray);
  CHECK(open["volume"].is_null());
  CHECK(open["faults"].dump().find("wrap it") != std::string::npos);
  const std::string out = (folder / "wrap.obj").string();
  const std::vector<std::string> coarse = {"--wrap=0.1", "--wrap-cell", "0.04", "--wrap-offset",
                                           "0.05"};
  std::vector<std::string> all = coarse;
  for (const char* more : {"--sdf", "--decompose", "--concavity", "0.1"}) all.push_back(more);
  const Json m = mesh_facts_of(tray, all);
  CHECK(m["solid"] == true);
  CHECK(m["faults"].empty());
  CHECK(m["wrap"]["missing"] == 0);
  CHECK(m["wrap"]["added"].get<double>() > 0.049);
  CHECK(m["wrap"]["nearest"].get<double>() >= 0.025);
  CHECK(m["wrap"]["added"].get<double>() <= m["wrap"]["bound"].get<double>());
  // Walls of .1 m by an offset of .05: between those of bare walls and a filled tray.
  CHECK(m["volume"].get<double>() > 0.1 * (1 + 4 * 0.4));
  CHECK(m["volume"].get<double>() < 1.1 * 1.1 * 0.5);
  CHECK(m["decomposition"]["pieces"].size() > 3);
  CHECK(m["distance_field"]["blocks"].get<size_t>() > 0);
  // What is written is what is told of.
  std::vector<std::string> written = coarse;
  for (const std::string& more : {std::string("--out"), out}) written.push_back(more);
  CHECK(mesh_facts_of(tray, written)["wrap"]["out"] == out);
  CHECK(mesh_facts_of(out)["volume"].get<double>() ==
        doctest::Approx(m["volume"].get<double>()).epsilon(1e-9));
  for (const char* bad : {"--wrap=no", "--wrap=-1", "--wrap=1e9"})
    CHECK(tumble_program({"mesh", tray, bad}).code == 2);
  const ProgramRun apart = tumble_program({"mesh", tray, "--wrap", "0.1"});
  CHECK(apart.code == 2);
  CHECK(mentions(apart.err, "write --wrap=0.1;"));
  CHECK(tumble_program({"mesh", tray, "--out", out}).code == 2);
  CHECK(tumble_program({"mesh", tray, "--wrap", "--wrap-cell", "1e-6"}).code == 3);
}

TEST_CASE("what cannot be loaded is 3, wrong usage 2, and stdout stays empty") {
  TempFolder folder;
  const std::string cube = (assets / "l_part.obj").string();
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"empty.obj", ""},
      {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
      {"nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"far.obj", "v 1e300 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"torn.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0"},
      {"noise.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\n"},
      {"huge.off", "OFF\n2000000000 2000000000 0\n"},
      {"strange.xyz", "1 2 3"},
  };
  for (const auto& [file, text] : bad) {
    const auto& name = file;
    const ProgramRun run = tumble_program({"mesh", write_text(folder / name, text), "--json"});
    CHECK_MESSAGE(run.code == 3, name << ": " << run.code << " " << run.err);
    CHECK_MESSAGE(run.out.empty(), name);
    CHECK_MESSAGE(mentions(run.err, name), run.err);
  }
  const std::vector<std::vector<std::string>> wrong = {
      {"--hierarchy", "obb"},
      {"--size", "10x10"},
      {"--render", "a.png", "--level", "2"},
      {"--render", "a.png", "--hierarchy", "brute_force"},
      {"--render", "a.png", "--hierarchy", "obb", "--level", "-1"},
      {"--render", "a.png", "--size", "0x10"},
      {"--density", "0"},
      {"--scale", "nan"},
      {"--density", "nan"},
  };
  for (std::vector<std::string> more : wrong) {
    const std::string what = more.back();
    more.insert(more.begin(), {"mesh", cube});
    const ProgramRun run = tumble_program(more);
    CHECK_MESSAGE(run.code == 2, what << ": " << run.err);
    CHECK(run.out.empty());
  }
  CHECK(!fs::exists("a.png"));
}
