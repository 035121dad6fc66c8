#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "engine/scene/mesh_import.hpp"
#include "viewer/app/command.hpp"

#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

struct MeshLine {
  std::string file, up = "y";
  double scale = 1;
  bool json = false;
};

/// Everything that is said of a mesh.
struct MeshFacts {
  size_t triangles = 0, vertices = 0;
  MeshTopology topology;
  Aabb box;
  double area = 0;
  Result<MassProperties> mass = MassProperties{};
  std::vector<std::string> notes;
};

MeshFacts facts_of(const ImportedMesh& imported) {
  MeshFacts f;
  f.triangles = imported.mesh.triangles.size();
  f.vertices = imported.mesh.vertices.size();
  f.topology = build_topology(imported.mesh);
  f.box = bounds(imported.mesh);
  f.area = surface_area(imported.mesh);
  f.mass = mesh_mass(imported.mesh);
  f.notes = imported.notes;
  return f;
}

using Json = nlohmann::ordered_json;

Json vector_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

void print_json(const std::string& file, const MeshFacts& f) {
  Json out = {{"file", file},
              {"triangles", f.triangles},
              {"vertices", f.vertices},
              {"closed", f.topology.closed_and_oriented()},
              {"open_edges", f.topology.open_edges},
              {"non_manifold_edges", f.topology.non_manifold_edges},
              {"misoriented_edges", f.topology.misoriented_edges},
              {"euler_characteristic", f.topology.euler_characteristic},
              {"bounds", {{"min", vector_json(f.box.min)}, {"max", vector_json(f.box.max)}}},
              {"area", f.area}};
  if (f.mass) {
    const Mat3& i = f.mass->inertia;
    out["volume"] = f.mass->mass;
    out["centre"] = vector_json(f.mass->centre);
    out["inertia_per_density"] = {
        {i(0, 0), i(0, 1), i(0, 2)}, {i(1, 0), i(1, 1), i(1, 2)}, {i(2, 0), i(2, 1), i(2, 2)}};
  } else {
    out["volume"] = nullptr;
    out["no_volume_because"] = f.mass.error().text();
  }
  out["notes"] = f.notes;
  fmt::print("{}\n", out.dump(2, ' ', false, Json::error_handler_t::replace));
}

std::string vector_text(const Vec3& v) {
  return fmt::format("{:.6g} {:.6g} {:.6g}", v.x(), v.y(), v.z());
}

void print_text(const std::string& file, const MeshFacts& f) {
  const MeshTopology& t = f.topology;
  fmt::print("{}\n  triangles {}, vertices {}\n", file, f.triangles, f.vertices);
  if (t.closed_and_oriented())
    fmt::print("  closed, Euler characteristic {}\n", t.euler_characteristic);
  else
    fmt::print("  not a closed solid: {} open, {} non-manifold, {} misoriented edges\n",
               t.open_edges, t.non_manifold_edges, t.misoriented_edges);
  fmt::print("  bounds [m]     {}  to  {}\n  size [m]       {}\n  area [m2]      {:.6g}\n",
             vector_text(f.box.min), vector_text(f.box.max), vector_text(f.box.extent()), f.area);
  if (f.mass) {
    const Mat3& i = f.mass->inertia;
    fmt::print("  volume [m3]    {:.6g}\n  centre [m]     {}\n", f.mass->mass,
               vector_text(f.mass->centre));
    fmt::print("  inertia about the centre, for 1 kg/m3 [kg m2]\n");
    for (int row = 0; row < 3; ++row)
      fmt::print("    {:>13.6g} {:>13.6g} {:>13.6g}\n", i(row, 0), i(row, 1), i(row, 2));
  } else {
    fmt::print("  no volume: {}\n", f.mass.error().text());
  }
  for (const std::string& note : f.notes) fmt::print("  note: {}\n", note);
}

int run_mesh(const MeshLine& line) {
  ImportOptions options;
  options.scale = line.scale;
  options.up = line.up == "z" ? UpAxis::z : line.up == "x" ? UpAxis::x : UpAxis::y;
  const auto mesh = import_mesh(line.file, options);
  if (!mesh) return report(mesh.error(), exit_bad_input);
  const MeshFacts facts = facts_of(*mesh);
  line.json ? print_json(line.file, facts) : print_text(line.file, facts);
  return exit_ok;
}

}  // namespace

CommandAction declare_mesh(CLI::App& app) {
  auto line = std::make_shared<MeshLine>();
  app.add_option("file", line->file, "OBJ, STL, PLY, OFF, glTF, DAE and many more")->required();
  app.add_option("--scale", line->scale, "metres per unit of the file")
      ->check(CLI::Range(1e-9, 1e9))
      ->capture_default_str();
  app.add_option("--up", line->up, "axis of the file that points up")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  app.add_flag("--json", line->json, "one JSON object on stdout");
  app.footer(
      "0 for everything that was loaded, closed or not; 3 for what cannot be.\n\n"
      "Examples:\n"
      "  tumble mesh part.stl --scale 0.001 --up z\n"
      "  tumble mesh assets/meshes/gear.obj --json");
  return [line] { return run_mesh(*line); };
}

}  // namespace tumble
