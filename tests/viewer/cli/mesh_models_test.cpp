// What `tumble mesh` computes of several hundred models that others made (package
// assimp-testmodels), each in a process of its own. References: edges counted with a map, signed
// tetrahedra and areas summed one by one; what is known of a few models by hand.
#include "engine/core/watched.hpp"
#include "engine/scene/mesh_import.hpp"
#include "tests/scene/child_process.hpp"
#include "tests/support/assimp_models.hpp"
#include "tests/support/scale.hpp"
#include "viewer/app/mesh/mesh_facts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

using namespace tumble;
namespace fs = std::filesystem;

namespace {

struct PlainMeasures {
  std::map<std::pair<uint32_t, uint32_t>, int> sides;  ///< by edge, how many triangles
  size_t open = 0, crowded = 0;
  double volume = 0, area = 0;

  explicit PlainMeasures(const TriangleMesh& m) {
    const Vec3 origin = m.vertices[m.triangles[0][0]];
    for (const Triangle& t : m.triangles) {
      const Vec3 a = m.vertices[t[0]] - origin, b = m.vertices[t[1]] - origin,
                 c = m.vertices[t[2]] - origin;
      volume += a.dot(b.cross(c)) / 6;
      area += 0.5 * (b - a).cross(c - a).norm();
      for (size_t k = 0; k < 3; ++k) ++sides[std::minmax(t[k], t[(k + 1) % 3])];
    }
    for (const auto& [edge, n] : sides) {
      open += n == 1;
      crowded += n > 2;
    }
  }
};

bool near(double a, double b, double tolerance) {
  return std::fabs(a - b) <= tolerance * std::max(std::fabs(a), std::fabs(b));
}

/// What does not fit the report of a mesh; empty when all does.
std::string doubt(const MeshFacts& f) {
  const PlainMeasures plain(*f.mesh);
  if (f.topology.open_edges != plain.open) return "open edges";
  if (f.topology.non_manifold_edges != plain.crowded) return "crowded edges";
  if (!near(f.area, plain.area, 1e-9)) return "area";
  size_t around = 0;
  for (const auto& hole : f.holes) around += hole.size();
  // Beside an edge of three triangles a border may end instead of closing.
  if (plain.crowded == 0 ? around != plain.open : around > plain.open) return "holes";
  size_t triangles = 0;
  for (const SolidShell& s : f.solid.shells) triangles += s.triangles;
  if (triangles > f.mesh->triangles.size()) return "shells";
  if (f.solid.solid() != f.mass.ok()) return "mass of what is no solid";
  for (const SolidFault& fault : f.solid.faults) {
    if (fault.count == 0 && fault.vertices.empty()) return "a fault of nothing";
    if (fault.text.empty() || (fault.blocks_mass && fault.cure.empty())) return "a silent fault";
    for (const auto& e : fault.edges) {
      const int n = plain.sides.at(std::minmax(e[0], e[1]));
      if (fault.kind == SolidFaultKind::open_border && n != 1) return "an open edge";
      if (fault.kind == SolidFaultKind::non_manifold_edge && n <= 2) return "a crowded edge";
    }
    for (const TriangleIds& ids : fault.pairs) {
      if (ids.a >= ids.b || ids.b >= f.mesh->triangles.size()) return "a pair";
    }
  }
  if (f.solid.solid()) {
    if (plain.open + plain.crowded > 0) return "a solid with a border";
    if (!(plain.volume > 0)) return "a solid without volume";
    if (!near(f.mass->mass, 2 * plain.volume, 1e-9)) return "volume";
    if (!f.box.inflated(1e-9).contains(f.mass->centre)) return "centre";
    if (!f.hull.missing.empty()) return "no hull: " + f.hull.missing;
    if (f.hull.volume < plain.volume * (1 - 1e-6)) return "hull less than the solid";
  } else if (f.mass.error().text().empty()) {
    return "no reason";
  }
  const auto json = nlohmann::json::parse(mesh_json(f, ""), nullptr, false);
  if (!json.is_object() || json["solid"] != f.solid.solid()) return "JSON";
  if (json["triangles"] != f.mesh->triangles.size()) return "JSON's triangles";
  return mesh_text(f).empty() ? "no text" : "";
}

/// "unread", "solid VOLUME OVER BOX", "no FAULTS", or "bad ...".
std::string verdict(const fs::path& file) {
  auto imported = import_mesh(file);
  if (!imported) return "unread";
  std::vector<double> told;
  const ProgressSink listen = [&](double share) { told.push_back(share); };
  const Watched watched(&listen);
  const MeshFacts f = mesh_facts(file.string(), std::move(*imported), 2);
  if (told.empty() || told.back() != 1 || !std::is_sorted(told.begin(), told.end()))
    return "bad progress";
  if (const std::string why = doubt(f); !why.empty()) return "bad " + why;
  if (f.solid.solid()) {
    return fmt::format("solid {:.4f}", 0.5 * f.mass->mass / f.box.extent().prod());
  }
  std::string out = "no";
  for (const SolidFault& fault : f.solid.faults) {
    if (fault.blocks_mass) out += fmt::format(" {}", to_string(fault.kind));
  }
  return out;
}

}  // namespace

TEST_CASE("the models of assimp: what is said of each fits what is counted") {
  if (!have_assimp_models()) return;
  const std::vector<fs::path> files = assimp_model_files();
  // Boxes fill their box, a corner cut off a cube is a sixth of it.
  std::map<std::string, std::string> known;
  for (const char* box :
       {"3DS/CameraRollAnim.3ds", "3DS/cube_with_diffuse_texture.3DS", "Collada/cube_tristrips.dae",
        "Collada/cube_with_2UVs.DAE", "FBX/boxWithCompressedCTypeArray.FBX", "FBX/phong_cube.fbx",
        "OBJ/box.obj", "OBJ/cube_with_vertexcolors.obj", "OFF/Cube.off", "PLY/cube.ply",
        "PLY/cube_binary.ply", "glTF/BoxTextured-glTF/BoxTextured.gltf",
        "glTF2/BoxTextured-glTF-Binary/BoxTextured.glb"}) {
    known[box] = "solid 1.0000";
  }
  known["AMF/test1.amf"] = "solid 0.1667";
  known["OBJ/spider.obj"] = "no open_border self_intersection";
  known["STL/Spider_binary.stl"] = "no open_border self_intersection";
  known["STL/sphereWithHole.stl"] = "no open_border";
  known["STL/triangle.stl"] = "no open_border";
  known["3DS/cubes_with_alpha.3DS"] = "no self_intersection";
  // Beside these the gate looks at every third.
  const size_t step = test::all_counts() ? 1 : 3;
  size_t looked_at = 0, solid = 0, other = 0;
  for (size_t i = 0; i < files.size(); ++i) {
    const fs::path& file = files[i];
    const std::string name = fs::relative(file, assimp_models).string();
    const auto expected = known.find(name);
    if (expected == known.end() && i % step != 0) continue;
    const ChildOutcome out = run_in_child([&] { return verdict(file); }, 120);
    CHECK_MESSAGE(!out.crashed, name);
    CHECK_MESSAGE(!out.timed_out, name);
    CHECK_MESSAGE(!out.text.starts_with("bad"), name << ": " << out.text);
    if (expected != known.end()) {
      CHECK_MESSAGE(out.text == expected->second, name << ": " << out.text);
      known.erase(expected);
    }
    ++looked_at;
    solid += out.text.starts_with("solid");
    other += out.text.starts_with("no");
  }
  for (const auto& [name, said] : known) FAIL_CHECK("there is no " << name);
  MESSAGE(looked_at, " files: ", solid, " solids, ", other, " other meshes");
  CHECK(solid >= 60 / step);
  CHECK(other >= 50 / step);
}
