// The committed meshes. References: the generator, byte by byte; a brute-force test of every edge
// against every triangle for self-intersection; the coordinates printed in assets/README.md.
#include "assets/generate/audit.hpp"
#include "assets/generate/catalogue.hpp"
#include "assets/generate/makers.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace fs = std::filesystem;
using namespace tumble;
using namespace tumble::assets;

namespace {

const fs::path root = fs::path(TUMBLE_SOURCE_DIR) / "assets";

std::string file_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// True when the open segment ab passes through the inside of triangle t (parallel ones never do).
bool pierces(const Vec3& a, const Vec3& b, const Vec3& t0, const Vec3& t1, const Vec3& t2) {
  const Vec3 e1 = t1 - t0, e2 = t2 - t0, d = b - a, p = d.cross(e2);
  const double det = e1.dot(p);
  if (std::abs(det) < 1e-15) return false;
  const Vec3 s = a - t0, q = s.cross(e1);
  const double u = s.dot(p) / det, v = d.dot(q) / det, at = e2.dot(q) / det;
  constexpr double margin = 1e-6;
  return u > margin && v > margin && u + v < 1 - margin && at > margin && at < 1 - margin;
}

int self_intersections(const Mesh& mesh) {
  struct Box {
    Aabb box;
    size_t triangle;
  };
  std::vector<Box> boxes;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    Aabb box;
    for (const int v : mesh.triangles[i]) box.include(mesh.vertices[size_t(v)]);
    boxes.push_back({box, i});
  }
  std::sort(boxes.begin(), boxes.end(),
            [](const Box& a, const Box& b) { return a.box.min.x() < b.box.min.x(); });
  int hits = 0;
  const auto edges_through = [&](size_t from, size_t into) {
    const auto &a = mesh.triangles[from], &b = mesh.triangles[into];
    for (size_t k = 0; k < 3; ++k) {
      const int i = a[k], j = a[(k + 1) % 3];
      if (std::count(b.begin(), b.end(), i) + std::count(b.begin(), b.end(), j) > 0) continue;
      hits +=
          pierces(mesh.vertices[size_t(i)], mesh.vertices[size_t(j)], mesh.vertices[size_t(b[0])],
                  mesh.vertices[size_t(b[1])], mesh.vertices[size_t(b[2])]);
    }
  };
  for (size_t i = 0; i < boxes.size(); ++i) {
    for (size_t j = i + 1; j < boxes.size() && boxes[j].box.min.x() <= boxes[i].box.max.x(); ++j) {
      if (!boxes[i].box.overlaps(boxes[j].box)) continue;
      edges_through(boxes[i].triangle, boxes[j].triangle);
      edges_through(boxes[j].triangle, boxes[i].triangle);
    }
  }
  return hits;
}

/// Both meshes, the second one placed.
Mesh together(Mesh first, const Mesh& second, const Pose& pose) {
  const int offset = int(first.vertices.size());
  for (const Vec3& v : second.vertices) first.vertices.push_back(pose.point(v));
  for (const auto& t : second.triangles) {
    first.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return first;
}

Pose turned(const Vec3& x, double degrees, const Vec3& axis) {
  return {x, axis_angle(axis, degrees * 3.14159265358979323846 / 180)};
}

/// True when the mesh has a vertex within 2 um of the point.
bool has_vertex(const Mesh& mesh, const Vec3& point) {
  return std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [&](const Vec3& v) { return (v - point).cwiseAbs().maxCoeff() < 2e-6; });
}

}  // namespace

TEST_CASE("the committed meshes are what the generator writes") {
  std::set<std::string> expected;
  for (const Asset& asset : all_assets()) {
    expected.insert(file_name(asset));
    const std::string text = file_text(root / "meshes" / file_name(asset));
    const bool same = text == file_text(asset, asset.make());
    CHECK_MESSAGE(same, file_name(asset), " is not up to date: run generate_assets assets/meshes");
  }
  std::set<std::string> present;
  for (const auto& entry : fs::directory_iterator(root / "meshes")) {
    present.insert(entry.path().filename().string());
  }
  CHECK(present == expected);
}

TEST_CASE("every mesh is one closed, oriented, sliver-free 2-manifold") {
  for (const Asset& asset : all_assets()) {
    const Audit report = audit(asset.make());
    CHECK_MESSAGE(report.faults.empty(), asset.name, ": ",
                  report.faults.empty() ? "" : report.faults.front());
    CHECK_MESSAGE(report.pieces == 1, asset.name);
  }
}

TEST_CASE("no mesh passes through itself") {
  // The test itself must be able to see a crossing.
  const Mesh crossed = together(make_ring(), make_gear(), Pose{});
  CHECK(self_intersections(crossed) > 50);
  for (const Asset& asset : all_assets()) {
    CHECK_MESSAGE(self_intersections(asset.make()) == 0, asset.name);
  }
}

TEST_CASE("marble channels begin and end where the README says") {
  struct Ends {
    Mesh mesh;
    Vec3 entry, exit;
  };
  const std::vector<Ends> all = {
      {make_marble_straight(), {-0.5, 0.1, 0}, {0.5, 0, 0}},
      {make_marble_curve_left(), {0, 0.047124, 0}, {0.3, 0, -0.3}},
      {make_marble_curve_right(), {0, 0.047124, 0}, {0.3, 0, 0.3}},
      {make_marble_spiral(), {-0.3, 1.6, 0.6}, {0.3, 0, 0.6}},
      {make_marble_zigzag(), {-0.5, 0.508496, 0.75}, {-0.5, 0, -0.75}},
      {make_marble_ramp(), {-0.580100, 0.419007, 0}, {0.6, 0, 0}},
      {make_marble_loop(), {-1.912089, 1.2, -0.13}, {0.5, 0, 0.13}},
  };
  const std::string readme = file_text(root / "README.md");
  for (const Ends& ends : all) {
    for (const Vec3& p : {ends.entry, ends.exit}) {
      CHECK_MESSAGE(has_vertex(ends.mesh, p), p.transpose());
      const std::string text = fmt::format("({:.3g}, {:.3g}, {:.3g})", p.x(), p.y(), p.z());
      CHECK_MESSAGE(readme.find(text) != std::string::npos, text, " is missing in the README");
    }
  }
}

TEST_CASE("parts fit each other as the README says, and no closer") {
  const auto clear = [](const Mesh& first, const Mesh& second, const Pose& pose) {
    return self_intersections(together(first, second, pose)) == 0;
  };
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  CHECK(clear(make_gear(), make_gear(), turned(0.48 * x, 11.25, y)));
  CHECK_FALSE(clear(make_gear(), make_gear(), turned(0.48 * x, 0, y)));
  CHECK(clear(make_torus_link(), make_torus_link(), turned(0.31 * x, 90, x)));
  CHECK_FALSE(clear(make_torus_link(), make_torus_link(), turned(0.32 * x, 90, x)));
  CHECK(clear(make_chain_link(), make_chain_link(), turned(0.43 * y, 90, y)));
  CHECK_FALSE(clear(make_chain_link(), make_chain_link(), turned(0.44 * y, 90, y)));
  CHECK(clear(make_hex_nut(), make_hex_bolt(), turned(Vec3::Zero(), 0, z)));
  CHECK(clear(make_washer(), make_hex_bolt(), turned(Vec3::Zero(), 0, z)));
  CHECK_FALSE(clear(make_hex_nut(), make_hex_bolt(), turned(0.02 * x, 0, z)));
}

TEST_CASE("the lock's plug turns in its case with the key in it, and pins part at its rim") {
  const auto clear = [](const Mesh& first, const Mesh& second, const Pose& pose) {
    return self_intersections(together(first, second, pose)) == 0;
  };
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  for (const double angle : {0.0, 37.0, 90.0})
    CHECK(clear(make_lock_case(), make_lock_plug(), turned(Vec3::Zero(), angle, x)));
  CHECK_FALSE(clear(make_lock_case(), make_lock_plug(), turned(0.002 * y, 0, x)));
  for (const double out : {0.001, 0.2})
    CHECK(clear(make_lock_plug(), make_lock_key(), turned(out * x, 90, x)));
  CHECK_FALSE(clear(make_lock_plug(), make_lock_key(), turned(0.001 * x + 0.002 * z, 90, x)));
  // Cut and pin together reach the middle of the gap about the plug, at every pin of the right key.
  const double at[] = {-0.12, -0.22, -0.32, -0.42}, lengths[] = {0.0705, 0.0905, 0.0785, 0.0655};
  int wrong = 0;
  for (size_t i = 0; i < 4; ++i) {
    const Vec3 cut(at[i] + 0.009, 0.008, -(0.1005 - lengths[i]));
    CHECK(has_vertex(make_lock_key(), cut));
    wrong += !has_vertex(make_lock_key_wrong(), cut);
  }
  CHECK(wrong == 3);
}

TEST_CASE("the README lists every mesh with its size, triangles and volume") {
  const std::string readme = file_text(root / "README.md");
  for (const Asset& asset : all_assets()) {
    const std::string row = table_row(asset);
    CHECK_MESSAGE(readme.find(row + "\n") != std::string::npos, "assets/README.md lacks: ", row);
  }
}
