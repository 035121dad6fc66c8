#include "engine/scene/description/body.hpp"
#include "engine/scene/description/shape.hpp"
#include "viewer/ui/arrange_form.hpp"
#include "viewer/ui/mesh_form.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"

#include <filesystem>
#include <tuple>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// A button that is lit while clicks create this; pressed again, it ends building.
void choice_button(PanelContext& context, const std::string& name, std::string_view doc,
                   const decltype(BuildChoice::what)& what, float width) {
  auto& building = context.state.building;
  const bool lit = building && context.state.build.what == what;
  const ImVec4 colour =
      ImGui::ColorConvertU32ToFloat4(lit ? palette::accent_soft : palette::raised);
  ImGui::PushStyleColor(ImGuiCol_Button, colour);
  if (ImGui::Button(label_of(name).c_str(), ImVec2(width, 0))) {
    building = !lit;
    context.state.handles.kind = HandleKind::none;
    context.state.build.what = what;
  }
  ImGui::PopStyleColor();
  context.host.mark("build." + name);
  tooltip_with_key(context, doc, {});
}

/// Lays out buttons two in a line.
class Pairs {
 public:
  Pairs() : width_(0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x)) {}
  float next() {
    if (count_++ % 2) ImGui::SameLine();
    return width_;
  }

 private:
  float width_;
  int count_ = 0;
};

void draw_bodies(PanelContext& context) {
  section(context, "Bodies");
  BuildChoice& build = context.state.build;
  ParameterWidgets widgets(context, "build");
  std::vector<std::string_view> names;
  for (const auto& [name, material] : built_in_materials()) names.push_back(name);
  widgets.choice(build.material, names, {.name = "material", .doc = "of new bodies"});
  widgets.field(build.type, {.name = "type", .doc = "how new bodies move"});
  Pairs pairs;
  const auto& shapes = all_shapes();
  for (size_t i = 0; i < shapes.size(); ++i)
    if (!made_of_mesh(shapes[i].type) && !shapes[i].parameters.empty())
      choice_button(context, std::string(shapes[i].name), "click on what it is to stand on",
                    NewBody{i}, pairs.next());
}

/// Choice of a mesh file; its bodies are placed like others.
void draw_meshes(PanelContext& context) {
  section(context, "Meshes from files");
  UiState& state = context.state;
  BuildChoice& build = state.build;
  if (ImGui::Button("Choose a file ...")) {
    state.choosing_mesh = true;
    state.shows(PanelId::scenes) = true;
    context.ask(BrowseFolder{build.mesh_file.empty()
                                 ? context.model.start_folder
                                 : std::filesystem::path(build.mesh_file).parent_path().string()});
  }
  context.host.mark("build.mesh_file");
  if (build.mesh_file.empty()) return;
  ParameterWidgets widgets(context, "build");
  MeshMode mode = build.mesh_mode;
  (void)choose_mesh_mode(widgets, mode, "what takes the place of the mesh in contacts");
  const bool lit = state.building && std::holds_alternative<NewMesh>(build.what);
  if (mode != build.mesh_mode) {
    build.mesh_mode = mode;
    if (lit) build.what = NewMesh{build.mesh_file, mode};
  }
  const std::string name = std::filesystem::path(build.mesh_file).stem().string();
  if (word_button(context, "build.mesh", name.c_str(), lit, "click on what it is to stand on",
                  {})) {
    state.building = !lit;
    state.handles.kind = HandleKind::none;
    build.what = NewMesh{build.mesh_file, mode};
  }
  if (context.model.reading_mesh) small_text(context, "being read ...", palette::faint);
  if (!context.model.palette_fault.empty())
    small_text(context, context.model.palette_fault, palette::red);
}

void draw_connections(PanelContext& context) {
  section(context, "Joints, motors and springs");
  Pairs pairs;
  for (const JointKindEntry& entry : all_joint_kinds())
    choice_button(context, std::string(entry.name),
                  fmt::format("{}; click on one body, where its anchor and axis are to be, then on "
                              "the other, or on nothing for the world",
                              entry.doc),
                  NewJoint{entry.kind}, pairs.next());
  choice_button(context, "motor",
                "a hinge that turns by itself; click on what it is to turn, where its axis is to "
                "be, then on what bears it, or on nothing for the world",
                NewJoint{JointKind::revolute, true}, pairs.next());
  choice_button(context, "spring", "click on a point of a body, then on another, or on nothing",
                NewSpring{}, pairs.next());
}

void draw_parts(PanelContext& context) {
  section(context, "Sources, cloths, fluids and sensors");
  constexpr std::tuple<const char*, PartKind, const char*> kinds[] = {
      {"emitter", PartKind::emitter,
       "click where it is to be; it makes copies of the selected body, or particles where none is "
       "selected"},
      {"cloth", PartKind::cloth, "click on what it is to hang over; it is woven above that place"},
      {"net", PartKind::net, "click on what it is to hang over; it is knotted above that place"},
      {"particles", PartKind::heap, "click on what they are to fall on"},
      {"fluid", PartKind::fluid, "click on what it is to stand on: a block of water"},
      {"gate", PartKind::gate, "click where it is to count what goes through"},
      {"region", PartKind::region, "click where it is to count what is there"}};
  Pairs pairs;
  for (const auto& [name, kind, doc] : kinds)
    choice_button(context, name, doc, NewPart{kind}, pairs.next());
}

}  // namespace

void draw_build_panel(PanelContext& context) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(6, 4));
  draw_arrange_form(context);
  draw_bodies(context);
  draw_meshes(context);
  draw_connections(context);
  draw_parts(context);
  note(context.state.building ? "Click on the picture. Esc ends." : "Choose what clicks build.");
  ImGui::PopStyleVar();
}

}  // namespace tumble
