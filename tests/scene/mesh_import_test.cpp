// Mesh files. References: counts and volumes of known solids; several hundred models of every
// format and fault that others made (package assimp-testmodels), each read in a process of its own;
// files damaged on purpose.
#include "engine/scene/mesh_import.hpp"

#include "engine/core/random.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "engine/scene/mesh_files/formats.hpp"
#include "engine/scene/mesh_files/limited_reader.hpp"
#include "tests/scene/child_process.hpp"
#include "tests/support/assimp_models.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <map>

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace tumble;
namespace fs = std::filesystem;

namespace {

/// A folder to write files to that goes with the test.
struct Folder : TempFolder {
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path() / name, std::ios::binary) << text;
    return path() / name;
  }
};

std::string read_all(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// "ok TRIANGLES" or "no REASON", or "bad ..." for a mesh that should not have come through.
std::string outcome(const fs::path& file) {
  const auto mesh = import_mesh(file);
  if (!mesh) {
    const std::string text = mesh.error().text();
    return text.find(file.string()) == std::string::npos ? "bad no place: " + text : "no " + text;
  }
  if (const Status ok = validate(mesh->mesh); !ok) return "bad " + ok.error().text();
  if (mesh->parts.empty()) return "bad no parts";
  return fmt::format("ok {}", mesh->mesh.triangles.size());
}

void check_refused(const fs::path& file, const char* why) {
  const auto mesh = import_mesh(file);
  REQUIRE_MESSAGE(!mesh.ok(), file.string());
  CHECK_MESSAGE(mesh.error().text().find(why) != std::string::npos, mesh.error().text());
}

std::string ply_box(const char* x = "1") {
  return fmt::format(
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement vertex 8\r\nproperty double x\r\n"
      "property double y\r\nproperty double z\r\nelement face 6\r\n"
      "property list uchar int vertex_indices\r\nend_header\r\n"
      "0 0 0\r\n{0} 0 0\r\n0 1 0\r\n{0} 1 0\r\n0 0 1\r\n{0} 0 1\r\n0 1 1\r\n{0} 1 1\r\n"
      "4 0 4 6 2\r\n4 1 3 7 5\r\n4 0 1 5 4\r\n4 2 6 7 3\r\n4 0 2 3 1\r\n4 4 5 7 6\r\n",
      x);
}

std::string base64(const std::vector<unsigned char>& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    unsigned v = 0;
    for (size_t k = 0; k < 3; ++k) v = (v << 8) | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) {
      out += i + k > bytes.size() ? '=' : digits[(v >> (18 - 6 * k)) & 63];
    }
  }
  return out;
}

/// A glTF file with one tetrahedron that two nodes place: one moved, one mirrored and moved.
std::string gltf_two_tetrahedra() {
  const TriangleMesh t = make_mesh::tetrahedron(1);
  std::vector<unsigned char> bytes;
  const auto put = [&](const void* p, size_t n) {
    const auto* b = static_cast<const unsigned char*>(p);
    bytes.insert(bytes.end(), b, b + n);
  };
  for (const Vec3& v : t.vertices) {
    const Vec3f f = v.cast<float>();
    put(f.data(), 12);
  }
  for (const Triangle& c : t.triangles) {
    for (uint32_t v : c) {
      const auto s = uint16_t(v);
      put(&s, 2);
    }
  }
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],
"nodes":[{{"name":"a","mesh":0,"translation":[5,0,0]}},
{{"name":"b","mesh":0,"translation":[-5,0,0],"scale":[-2,2,2]}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]}},
{{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":24}}],
"buffers":[{{"byteLength":72,"uri":"data:application/octet-stream;base64,{}"}}]}})",
      base64(bytes));
}

}  // namespace

TEST_CASE("the models of assimp: each loads or is refused with a reason, none crashes or hangs") {
  if (!have_assimp_models()) return;
  const std::vector<fs::path> files = assimp_model_files();
  std::map<std::string, int> loaded;  // by extension
  int total = 0;
  const size_t step = test::only_to_run() ? 8 : 1;
  for (size_t i = 0; i < files.size(); i += step) {
    const fs::path& file = files[i];
    const ChildOutcome out = run_in_child([&] { return outcome(file); }, 60);
    CHECK_MESSAGE(!out.crashed, file.string());
    CHECK_MESSAGE(!out.timed_out, file.string());
    CHECK_MESSAGE((out.text.starts_with("ok ") || out.text.starts_with("no ")), file.string(), ": ",
                  out.text);
    if (!out.text.starts_with("ok ")) continue;
    ++loaded[file.extension().string()];
    ++total;
  }
  std::string summary;
  for (const auto& [extension, n] : loaded) summary += fmt::format(" {} {}", extension, n);
  MESSAGE(files.size(), " files, ", total, " loaded:", summary);
  CHECK(files.size() > 500);
  if (step > 1) return;
  CHECK(total >= 120);
  CHECK(loaded[".obj"] >= 12);
  CHECK(loaded[".stl"] >= 5);
  CHECK(loaded[".ply"] >= 4);
  CHECK(loaded[".off"] >= 2);
  CHECK(loaded[".gltf"] + loaded[".glb"] >= 20);
  CHECK(loaded[".dae"] + loaded[".DAE"] >= 15);
}

TEST_CASE("models with a known answer") {
  if (!have_assimp_models()) return;
  const auto triangles = [](const char* file) {
    const auto mesh = import_mesh(assimp_models / file);
    REQUIRE_MESSAGE(mesh.ok(), test::why_not(mesh));
    return mesh->mesh.triangles.size();
  };
  CHECK(triangles("OBJ/box.obj") == 12);
  CHECK(triangles("PLY/cube.ply") == 12);
  CHECK(triangles("PLY/cube_binary.ply") == 12);
  CHECK(triangles("OFF/Cube.off") == 12);
  CHECK(triangles("glTF2/BoxTextured-glTF/BoxTextured.gltf") == 12);
  CHECK(triangles("glTF2/BoxTextured-glTF-Binary/BoxTextured.glb") == 12);
  CHECK(triangles("STL/Spider_ascii.stl") == triangles("STL/Spider_binary.stl"));
  CHECK(triangles("STL/triangle_with_empty_solid.stl") == 1);
  for (const char* cube :
       {"OBJ/box.obj", "PLY/cube.ply", "OFF/Cube.off", "glTF2/BoxTextured-glTF/BoxTextured.gltf"}) {
    const auto mesh = import_mesh(assimp_models / cube);
    const Vec3 e = bounds(mesh->mesh).extent();
    const auto mass = mesh_mass(mesh->mesh);
    REQUIRE_MESSAGE(mass.ok(), cube);
    CHECK(mass->mass == doctest::Approx(e.x() * e.y() * e.z()).epsilon(1e-6));
  }
  check_refused(assimp_models / "glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb",
                "not finite");
  check_refused(assimp_models / "invalid/OutOfMemory.off", "are declared, but only");
  check_refused(assimp_models / "invalid/empty.obj", "empty");
  check_refused(assimp_models / "OBJ/point_cloud.obj", "no triangles");
}

TEST_CASE("files that are not there or not meshes") {
  const Folder folder;
  check_refused(folder / "absent.obj", "no such file");
  check_refused(folder.path(), "not a file");
  check_refused(folder.write("empty.stl", ""), "empty");
  check_refused(folder.write("notes.txt", "hello"), "type 'txt' are not read");
  check_refused(folder.write("bare", "hello"), "without extension");
  check_refused(folder.write("noise.stl", std::string(300, '\x80')), "noise.stl");
  check_refused(folder.write("short.stl", "no solid"), "is no STL file");
  check_refused(folder.write("cut.stl", std::string(80, ' ') + std::string("\2\0\0\0", 4) +
                                            std::string(50, '\0')),
                "a binary one of 2 triangles has 184 bytes, not 134");
  check_refused(folder.write("text.ply", "hello"), "starts with 'ply'");
  check_refused(folder.write("text.off", "hello\n"), "starts with 'OFF'");
  check_refused(folder.write("points.obj", "v 0 0 0\nv 1 0 0\n"), "points.obj");
  check_refused(folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), "without area");
  check_refused(folder.write("nan.ply", ply_box("nan")), "not finite");
  check_refused(folder.write("huge.ply", ply_box("1e999")), "not finite");
  check_refused(folder.write("far.ply", ply_box("1e30")), "at most 2000000000 m are allowed");
}

TEST_CASE("counts that the file cannot hold are refused before memory is taken") {
  const Folder folder;
  std::string ply = ply_box();
  for (const char* count : {"1000000000", "4294967295", "99999999999999999999", "-1"}) {
    std::string damaged = ply;
    damaged.replace(damaged.find("vertex 8"), 8, fmt::format("vertex {}", count));
    check_refused(folder.write("count.ply", damaged), "count.ply");
    check_refused(folder.write("count.off", fmt::format("OFF\n{} 1 0\n0 0 0\n3 0 1 2\n", count)),
                  "count.off");
    check_refused(folder.write("faces.off", fmt::format("OFF\n1 {} 0\n0 0 0\n3 0 1 2\n", count)),
                  "faces.off");
  }
  check_refused(folder.write("cut.ply", ply.substr(0, ply.size() - 20)), "of 'face' 4");
  check_refused(folder.write("header.ply", ply.substr(0, 60)), "header has no end");
  check_refused(folder.write("corner.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3000000 0 1 2\n"),
                "sensible number");
}

TEST_CASE("a corner number that is no whole number is no other corner") {
  const Folder folder;
  const std::string points = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  check_refused(folder.write("exponent.off", points + "3 0 1 1e308\n3 0 1 2\n"), "whole numbers");
}

TEST_CASE("a damaged file that the library reads for ever is refused in bounded time") {
  // A PLY file with three damaged bytes under the name of another format.
  std::string ply = ply_box();
  ply[ply.find("property") + 2] = '\xef';
  const Folder folder;
  const auto start = std::chrono::steady_clock::now();
  check_refused(folder.write("named.gltf", ply), "named.gltf");
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  CHECK(spent.count() < 70);
}

namespace {
Result<PolygonFile> hangs(const fs::path&) {
  volatile bool on = true;
  while (on) {
  }
  return PolygonFile{};
}
Result<PolygonFile> sleeps(const fs::path&) {
  for (;;) ::pause();
}
Result<PolygonFile> crashes(const fs::path&) {
  std::raise(SIGSEGV);
  return PolygonFile{};
}
Result<PolygonFile> devours(const fs::path&) {
  std::vector<std::vector<char>> all;
  for (;;) all.emplace_back(size_t{64} << 20, 'x');
}
Result<PolygonFile> refuses(const fs::path& file) {
  return Error{ErrorCode::parse, "no mesh", file.string(), "another file"};
}
Result<PolygonFile> reads(const fs::path&) {
  PolygonFile out;
  out.begin_part("one");
  out.vertices.assign(100'000, Vec3(1, 2, 3));
  out.corners = {0, 1, 2, 2, 1, 0};
  out.end_polygon();
  out.begin_part("two");
  out.dropped_polygons = 7;
  return out;
}
}  // namespace

TEST_CASE("readers that are not to be trusted: whatever they do, the program goes on") {
  if (!reads_in_a_process_of_its_own()) return;
  const ReadingLimits limits{2, uint64_t{256} << 20};
  const auto message = [&](auto* reader) {
    const auto got = read_limited("x.obj", reader, limits);
    REQUIRE_FALSE(got.ok());
    CHECK(got.error().place == "x.obj");
    return got.error().message;
  };
  CHECK(message(hangs) == "reading it takes more than 2 s");
  CHECK(message(sleeps) == "reading it takes more than 2 s");
  CHECK(message(crashes).find("crashed") != std::string::npos);
  CHECK(message(refuses) == "no mesh");
  CHECK(message(devours).find("256 MiB of memory") != std::string::npos);
  const auto whole = read_limited("x.obj", reads, limits);
  REQUIRE(whole.ok());
  const PolygonFile same = *reads("");
  CHECK(whole->vertices == same.vertices);
  CHECK(whole->corners == same.corners);
  CHECK(whole->polygon_first == same.polygon_first);
  CHECK(whole->dropped_polygons == 7);
  REQUIRE(whole->parts.size() == 2);
  CHECK(whole->parts[1].name == "two");
  CHECK(whole->parts[1].first_vertex == 100'000);
}

TEST_CASE("T-junctions and seams of a file: closed with the volume of the solid") {
  const Folder folder;
  const auto file = [&](const char* y) {
    return folder.write(
        "t.obj", fmt::format("v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nv 1 {} 0\nf 1 3 2\nf 1 4 3\n"
                             "f 2 3 4\nf 1 5 4\nf 5 2 4\nf 1 2 5\n",
                             y));
  };
  for (const char* y : {"0", "1e-7"}) {
    ImportOptions options;
    options.weld = 1e-6;
    for (const bool given : {false, true}) {
      const auto mesh = import_mesh(file(y), given ? options : ImportOptions{});
      REQUIRE(mesh.ok());
      CHECK(build_topology(mesh->mesh).closed_and_oriented());
      CHECK(mesh_mass(mesh->mesh)->mass == doctest::Approx(4.0 / 3).epsilon(1e-6));
    }
  }
  // A box whose faces were written to six digits each: open until it is welded.
  std::string stl = "solid box\n";
  TriangleMesh box = make_mesh::box(Vec3::Constant(0.5));
  Random random(3);
  for (const Triangle& t : box.triangles) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const uint32_t v : t) {
      const Vec3 p =
          box.vertices[v] + 1e-6 * Vec3(random.uniform(), random.uniform(), random.uniform());
      stl += fmt::format("vertex {} {} {}\n", p.x(), p.y(), p.z());
    }
    stl += "endloop\nendfacet\n";
  }
  const auto seams = folder.write("seams.stl", stl + "endsolid box\n");
  CHECK_FALSE(build_topology(import_mesh(seams)->mesh).closed());
  ImportOptions welded;
  welded.weld = 1e-5;
  CHECK(build_topology(import_mesh(seams, welded)->mesh).closed());
  welded.weld = 0.5;
  const auto refused = import_mesh(seams, welded);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.error().message.find("weld is 0.5 m") != std::string::npos);
}

TEST_CASE("PLY as text and binary in either byte order, with all digits, OFF likewise") {
  const Folder folder;
  const auto text = import_mesh(folder.write("box.ply", ply_box("0.12345678901234567")));
  REQUIRE(text.ok());
  CHECK(text->mesh.vertices.size() == 8);
  CHECK(bounds(text->mesh).max.x() == 0.12345678901234567);
  CHECK(mesh_mass(text->mesh)->mass == doctest::Approx(0.12345678901234567));

  for (const bool big : {false, true}) {
    std::string ply = fmt::format(
        "ply\nformat binary_{}_endian 1.0\nelement vertex 4\nproperty uchar red\n"
        "property double x\nproperty float y\nproperty short z\nelement face 4\n"
        "property list ushort uint vertex_index\nproperty float quality\nend_header\n",
        big ? "big" : "little");
    const auto put = [&](auto value) {
      char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      if (big) std::reverse(bytes, bytes + sizeof value);
      ply.append(bytes, sizeof value);
    };
    const TriangleMesh t = make_mesh::tetrahedron(std::sqrt(3.0));
    for (const Vec3& v : t.vertices) {
      put(uint8_t(9));
      put(v.x());
      put(float(v.y()));
      put(int16_t(std::lround(v.z())));
    }
    for (const Triangle& c : t.triangles) {
      put(uint16_t(3));
      for (uint32_t v : c) put(v);
      put(1.0f);
    }
    const auto mesh = import_mesh(folder.write("t.ply", ply));
    REQUIRE_MESSAGE(mesh.ok(), test::why_not(mesh));
    CHECK(mesh_mass(mesh->mesh)->mass == doctest::Approx(8.0 / 3));
  }
  const auto off = import_mesh(
      folder.write("box.off",
                   "COFF # with colours\n8 6 12\n0 0 0 1 1 1\n0.1 0 0\n0 1 0\n0.1 1 0\n0 0 1\n"
                   "0.1 0 1\n\n# a comment\n0 1 1\n0.1 1 1\n4 0 4 6 2 0.5 0.5 0.5\n4 1 3 7 5\n"
                   "4 0 1 5 4\n4 2 6 7 3\n4 0 2 3 1\n4 4 5 7 6"));
  REQUIRE_MESSAGE(off.ok(), test::why_not(off));
  CHECK(bounds(off->mesh).max.x() == 0.1);
  CHECK(mesh_mass(off->mesh)->mass == doctest::Approx(0.1));
}

TEST_CASE("scale, stretch, up axis and centre") {
  const Folder folder;
  const fs::path file = folder.write("box.ply", ply_box("4"));  // 4 x 1 x 1 from the origin
  const auto extent = [&](ImportOptions options) {
    const auto mesh = import_mesh(file, options);
    REQUIRE(mesh.ok());
    CHECK(mesh_mass(mesh->mesh).ok());  // closed and outward, mirrored or not
    return bounds(mesh->mesh);
  };
  CHECK(extent({}).max == Vec3(4, 1, 1));
  CHECK(extent({.scale = 0.001}).max.isApprox(Vec3(0.004, 0.001, 0.001)));
  CHECK(extent({.stretch = Vec3(1, 2, 3)}).max == Vec3(4, 2, 3));
  CHECK(extent({.stretch = Vec3(-1, 2, 3)}).min == Vec3(-4, 0, 0));
  CHECK(extent({.up = UpAxis::z}).extent() == Vec3(4, 1, 1));
  CHECK(extent({.up = UpAxis::x}).max.y() == 4);
  CHECK(extent({.centre = true}).min == Vec3(-2, -0.5, -0.5));
}

TEST_CASE("node transforms are applied, mirrored parts stay outward, parts are named") {
  const Folder folder;
  const auto mesh = import_mesh(folder.write("two.gltf", gltf_two_tetrahedra()));
  REQUIRE_MESSAGE(mesh.ok(), test::why_not(mesh));
  REQUIRE(mesh->parts.size() == 2);
  CHECK(mesh->parts[0].triangles == 4);
  CHECK(mesh->mesh.vertices.size() == 8);
  const double one = mesh_integrals(make_mesh::tetrahedron(1)).mass;
  const auto mass = mesh_mass(mesh->mesh);
  REQUIRE_MESSAGE(mass.ok(), test::why_not(mass));
  CHECK(mass->mass == doctest::Approx(9 * one).epsilon(1e-6));
  CHECK(mass->centre.x() == doctest::Approx((5 - 8 * 5) / 9.0).epsilon(1e-6));
}

TEST_CASE("faces of a material each close, solids that touch stay apart, bad faces are left out") {
  const Folder folder;
  std::string faces, cubes;
  const TriangleMesh box = make_mesh::box(Vec3::Ones());
  size_t n = 1;
  for (size_t t = 0; t < box.triangles.size(); ++t) {
    faces += fmt::format("o part{}\n", t);
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& v = box.corner(t, k);
      faces += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
    }
    faces += fmt::format("f {} {} {}\n", n, n + 1, n + 2);
    n += 3;
  }
  const auto closed = import_mesh(folder.write("faces.obj", faces));
  REQUIRE(closed.ok());
  CHECK(closed->mesh.vertices.size() == 8);
  CHECK(closed->cleanup.open_edges == 0);
  CHECK(closed->notes.empty());

  for (int i = 0; i < 2; ++i) {  // share an edge
    cubes += fmt::format("o cube{}\n", i);
    for (const Vec3& v : box.vertices) {
      cubes += fmt::format("v {} {} {}\n", v.x() + 2 * i, v.y() + 2 * i, v.z());
    }
    for (const Triangle& t : box.triangles) {
      const auto base = uint32_t(8 * i + 1);
      cubes += fmt::format("f {} {} {}\n", t[0] + base, t[1] + base, t[2] + base);
    }
  }
  const auto two = import_mesh(folder.write("cubes.obj", cubes));
  REQUIRE(two.ok());
  CHECK(mesh_mass(two->mesh)->mass == doctest::Approx(16));

  std::string bad = ply_box();
  bad.replace(bad.find("4 4 5 7 6"), 9, "4 4 5 7 9");
  const auto left_out = import_mesh(folder.write("bad.ply", bad));
  REQUIRE(left_out.ok());
  CHECK(left_out->mesh.triangles.size() == 10);
  REQUIRE(left_out->notes.size() == 1);
  CHECK(left_out->notes[0].find("1 face") != std::string::npos);
}

TEST_CASE("false counts in Collada files are refused before the library believes them") {
  if (!have_assimp_models()) return;
  const Folder folder;
  const std::string good = read_all(assimp_models / "Collada/cube_tristrips.dae");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string bytes = good;
    const size_t at = bytes.find(from);
    REQUIRE(at != std::string::npos);
    return folder.write("false.dae", bytes.replace(at, from.size(), to));
  };
  CHECK(import_mesh(folder.write("good.dae", good)).ok());
  check_refused(with("normals-array\" count=\"72\"", "normals-array\" count=\"0\""), "holds 72");
  check_refused(with("count=\"72\"", "count=\"999999999\""), "cannot hold");
  check_refused(with("stride=\"3\"", "stride=\"30\""), "<accessor> takes");
}

TEST_CASE("damaged copies of good files never crash or hang") {
  if (!have_assimp_models()) return;
  const int copies = test::scaled_count(16, 2);
  const Folder folder;
  for (const char* name :
       {"OBJ/spider.obj", "STL/Spider_ascii.stl", "STL/Spider_binary.stl", "PLY/cube.ply",
        "PLY/cube_binary.ply", "OFF/Cube.off", "glTF2/BoxTextured-glTF-Binary/BoxTextured.glb",
        "glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf", "Collada/sphere.dae",
        "Collada/cube_tristrips.dae", "FBX/box.fbx", "3DS/fels.3ds", "X3D/HelloX3dTrademark.x3d",
        "AC/Wuson.ac", "MS3D/twospheres.ms3d", "AMF/test1.amf"}) {
    const fs::path source = assimp_models / name;
    const std::string good = read_all(source);
    REQUIRE_FALSE(good.empty());
    Random random(good.size());
    for (int i = 0; i < copies; ++i) {
      std::string bytes = good;
      const auto size = uint32_t(bytes.size());
      if (i % 3 == 0) {
        bytes.resize(random.below(size));
      } else {
        const uint32_t reach = i % 3 == 1 ? size : std::min(size, 400u);
        for (int k = 0; k < 5; ++k) bytes[random.below(reach)] = char(random.next());
      }
      const fs::path file = folder.write("damaged" + source.extension().string(), bytes);
      const ChildOutcome out = run_in_child([&] { return outcome(file); }, 30);
      CHECK_MESSAGE(!out.crashed, name, " ", i);
      CHECK_MESSAGE(!out.timed_out, name, " ", i);
      CHECK_MESSAGE(!out.text.starts_with("bad"), name, " ", i, ": ", out.text);
    }
  }
}
