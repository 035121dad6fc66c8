#include "viewer/ui/mesh_form.hpp"

#include "engine/scene/description/shape.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"

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
  cell(label_of(enum_name(f.mode)));
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
    widgets.field(mode, {.name = "mode", .doc = "what the mesh collides as; 9 draws it"});
    if (mode != source->how.mode)
      context.ask(ChangeMeshMode{
          context.model.selected, g, mode, source,
          fmt::format("Let the mesh of {} collide as {}", def.name, label_of(enum_name(mode)))});
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
