#include "viewer/ui/mesh_form.hpp"

#include "engine/scene/description/shape.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// In millimetres, e.g. "12.3"; less than a tenth of a micrometre is shown as zero.
std::string error_text(double metres) {
  return metres > 1e-7 ? fmt::format("{:.3g}", 1e3 * metres) : std::string("0");
}

std::string bytes_text(size_t bytes) {
  if (bytes < 10000) return fmt::format("{}", bytes);
  return bytes < 10000000 ? fmt::format("{}k", bytes / 1000) : fmt::format("{}M", bytes / 1000000);
}

void draw_row(PanelContext& context, const RepresentationFacts& f, bool in_use) {
  const auto cell = [&](const std::string& text) {
    ImGui::TableNextColumn();
    small_text(context, text, in_use ? palette::green : palette::dim);
  };
  cell(std::string(words_of(f.mode)));
  if (!f.refusal.empty()) {
    cell("-");
    tooltip_with_key(context, f.refusal, {});
    for (int column = 0; column < 4; ++column) cell("");
    return;
  }
  cell(fmt::format("{}", f.parts.parts.size()));
  tooltip_with_key(context, f.words, {});
  cell(bytes_text(f.bytes));
  cell(error_text(f.error.added));
  cell(error_text(f.error.missing));
  cell(fmt::format("{:.3g}", 1e-3 * f.query_ns));
}

void draw_comparison(PanelContext& context, const MeasuredMesh& measured, MeshMode in_use) {
  if (!ImGui::BeginTable("##representations", 6, ImGuiTableFlags_SizingStretchProp)) return;
  for (const char* title : {"collides as", "pieces", "bytes", "added", "missing", "query"}) {
    ImGui::TableNextColumn();
    small_text(context, title, palette::faint);
  }
  for (const RepresentationFacts& f : measured.all) draw_row(context, f, f.mode == in_use);
  ImGui::EndTable();
  note(
      "added, missing: how far it reaches outside the mesh, and the mesh out of it [mm]; query: "
      "contacts of a small ball [µs]");
}

}  // namespace

std::string_view words_of(MeshMode mode) {
  switch (mode) {
    case MeshMode::triangle_mesh:
      return "its triangles";
    case MeshMode::convex_hull:
      return "its convex hull";
    case MeshMode::decomposition:
      return "convex pieces";
    case MeshMode::field:
      return "a distance field";
    case MeshMode::fit:
      return "a simple shape";
  }
  return "";
}

bool choose_mesh_mode(ParameterWidgets& widgets, MeshMode& mode, std::string_view help) {
  const auto& all = EnumNames<MeshMode>::values;
  std::array<std::string_view, all.size()> names, words;
  size_t index = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    names[i] = all[i].first;
    words[i] = words_of(all[i].second);
    if (all[i].second == mode) index = i;
  }
  if (!widgets.choice(index, names, {.name = "mode", .doc = help}, words)) return false;
  mode = all[index].second;
  return true;
}

void draw_mesh_form(PanelContext& context, const BodyDef& def) {
  const std::vector<ShapeGroup> groups = shape_groups(def);
  constexpr size_t most = 8;
  for (size_t g = 0; g < std::min(groups.size(), most); ++g) {
    const auto source = source_of(def, groups[g]);
    if (!source) continue;
    section(context, groups.size() == 1 ? "Mesh" : fmt::format("Mesh {}", g + 1).c_str());
    ImGui::PushID(int(g));
    ParameterWidgets widgets(context, fmt::format("inspector.mesh.{}", g));
    MeshMode mode = source->how.mode;
    if (choose_mesh_mode(widgets, mode, "what takes the place of the mesh in contacts; 9 draws it"))
      context.ask(ChangeMeshMode{
          context.model.selected, g, mode, source,
          fmt::format("Let the mesh of {} collide as {}", def.name, words_of(mode))});
    if (context.model.changing_mesh) small_text(context, "being made ...", palette::faint);
    const MeasuredMesh* measured = context.model.measured_mesh.get();
    if (measured && measured->mesh == source->mesh) {
      draw_comparison(context, *measured, source->how.mode);
      context.host.mark(fmt::format("inspector.mesh.{}.table", g));
    } else if (context.model.measuring_mesh) {
      small_text(context, "being measured ...", palette::faint);
    } else {
      if (ImGui::Button("Compare all")) context.ask(MeasureMesh{source->mesh});
      context.host.mark(fmt::format("inspector.mesh.{}.compare", g));
      tooltip_with_key(context, "errors, size and cost of all that this mesh can collide as", {});
    }
    ImGui::PopID();
  }
}

}  // namespace tumble
