#include "viewer/app/mesh/mesh_facts.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Formats a number; one that is only rounding noise compared with `scale` is written as 0.
std::string number_text(double x, double scale) {
  return fmt::format("{:.6g}", std::abs(x) < 1e-14 * scale ? 0.0 : x);
}

std::string row_text(const Vec3& v) {
  const double scale = v.cwiseAbs().maxCoeff();
  return fmt::format("{:>12} {:>12} {:>12}", number_text(v.x(), scale), number_text(v.y(), scale),
                     number_text(v.z(), scale));
}

std::string counted(size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

void add_fact(std::string& out, const char* label, const std::string& text) {
  out += fmt::format("  {:<16}{}\n", label, text);
}

void add_surface(std::string& out, const MeshFacts& f) {
  const MeshTopology& t = f.topology;
  std::string closed = t.closed_and_oriented() ? "closed" : "not closed";
  if (t.open_edges) closed += ", " + counted(t.open_edges, "open edge", "open edges");
  if (t.non_manifold_edges)
    closed += ", " + counted(t.non_manifold_edges, "non-manifold edge", "non-manifold edges");
  if (t.misoriented_edges)
    closed += ", " + counted(t.misoriented_edges, "edge", "edges") + " of neighbours that disagree";
  add_fact(out, "surface",
           fmt::format("{}; Euler characteristic {}", closed, t.euler_characteristic));
  constexpr size_t most = 8;
  for (size_t i = 0; i < std::min(f.holes.size(), most); ++i) {
    Vec3 middle = Vec3::Zero();
    for (const uint32_t v : f.holes[i]) middle += f.mesh->vertices[v] / double(f.holes[i].size());
    add_fact(out, i ? "" : "holes",
             fmt::format("{} around ({:.4g}, {:.4g}, {:.4g})",
                         counted(f.holes[i].size(), "edge", "edges"), middle.x(), middle.y(),
                         middle.z()));
  }
  if (f.holes.size() > most) add_fact(out, "", fmt::format("and {} more", f.holes.size() - most));
  std::string faults = f.solid.text();
  while (!faults.empty()) {
    const size_t end = std::min(faults.find('\n'), faults.size());
    add_fact(out, "fault", faults.substr(0, end));
    faults.erase(0, end + 1);
  }
  if (f.solid.faults.empty())
    add_fact(out, "faults", "none: no self-intersection, all faces outwards");
  const std::string changed = f.cleanup.text();
  add_fact(out, "clean-up", changed.empty() ? "nothing to change" : changed);
}

void add_mass(std::string& out, const MeshFacts& f) {
  if (!f.mass) {
    add_fact(out, "volume", "none: " + f.mass.error().text());
    return;
  }
  const MassProperties& m = *f.mass;
  add_fact(out, "volume [m3]", fmt::format("{:.9g}", m.mass / f.density));
  add_fact(out, "mass [kg]", fmt::format("{:.9g}   at {:.6g} kg/m3", m.mass, f.density));
  add_fact(out, "centre [m]", row_text(m.centre));
  const double scale = m.inertia.cwiseAbs().maxCoeff();
  for (int row = 0; row < 3; ++row) {
    std::string line;
    for (int k = 0; k < 3; ++k)
      line += fmt::format("{:>12}{}", number_text(m.inertia(row, k), scale), k < 2 ? " " : "");
    add_fact(out, row ? "" : "inertia [kg m2]", line + (row ? "" : "   about the centre"));
  }
  add_fact(out, "principal", row_text(f.principal.moments) + "   moments [kg m2]");
  for (int k = 0; k < 3; ++k)
    add_fact(out, "", row_text(f.principal.axes.col(k)) + fmt::format("   axis {}", k + 1));
}

void add_hull(std::string& out, const MeshFacts& f) {
  if (!f.hull.missing.empty()) {
    add_fact(out, "hull", "none: " + f.hull.missing);
    return;
  }
  std::string text =
      fmt::format("{}, {}, {:.6g} m3", counted(f.hull.vertices, "vertex", "vertices"),
                  counted(f.hull.facets, "facet", "facets"), f.hull.volume);
  if (f.mass)
    text += fmt::format("; the mesh fills {:.4g} % of it",
                        100 * f.mass->mass / f.density / f.hull.volume);
  add_fact(out, "hull", text);
}

void add_hierarchies(std::string& out, const MeshFacts& f) {
  out +=
      "  hierarchy           nodes  depth  bytes/tri  root/hull  leaves/mesh  nodes/line  "
      "build ms\n";
  const auto ratio = [](const std::optional<double>& x) {
    return x ? fmt::format("{:.3f}", *x) : std::string("-");
  };
  for (const HierarchyFacts& h : f.hierarchies)
    out += fmt::format("    {:<13}{:>9}{:>7}{:>11.1f}{:>11}{:>13}{:>12.1f}{:>10.2f}\n", h.kind,
                       h.nodes, h.depth, h.bytes_per_triangle, ratio(h.root_over_hull),
                       ratio(h.leaves_over_mesh), h.nodes_per_line, h.build_ms);
}

}  // namespace

std::string mesh_text(const MeshFacts& f) {
  std::string out = f.file + "\n";
  add_fact(out, "format", f.format);
  add_fact(out, "size",
           fmt::format("{}, {}, {}", counted(f.mesh->triangles.size(), "triangle", "triangles"),
                       counted(f.mesh->vertices.size(), "vertex", "vertices"),
                       counted(f.solid.shells.size(), "connected part", "connected parts")));
  if (f.solid.cavities)
    add_fact(out, "", counted(f.solid.cavities, "of them is a cavity", "of them are cavities"));
  if (f.wrap) out += wrap_text(*f.wrap);
  add_surface(out, f);
  add_fact(out, "bounds [m]", row_text(f.box.min));
  add_fact(out, "", row_text(f.box.max));
  add_fact(out, "extent [m]", row_text(f.box.extent()));
  add_fact(out, "area [m2]", fmt::format("{:.9g}", f.area));
  add_mass(out, f);
  add_hull(out, f);
  add_hierarchies(out, f);
  if (f.pieces) out += pieces_text(*f.pieces);
  if (f.field) out += field_text(*f.field);
  if (f.fit) out += fit_text(*f.fit);
  if (!f.representations.empty()) out += representations_text(f.representations);
  for (const std::string& note : f.notes) add_fact(out, "note", note);
  return out;
}

}  // namespace tumble
