#include "viewer/interact/picking.hpp"
#include "viewer/ui/body_form.hpp"
#include "viewer/ui/joint_form.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

std::string_view type_text(const BodyInfo& info) {
  switch (info.type) {
    case BodyType::fixed:
      return "static";
    case BodyType::kinematic:
      return "kinematic";
    case BodyType::dynamic:
      return "dynamic";
  }
  return "";
}

void draw_motion(PanelContext& context, const BodyFrame& body, const BodyInfo& info) {
  section(context, "Motion");
  vector_row("position [m]", body.pose.x, 3);
  const Quat& q = body.pose.q;
  const double angle = 2 * std::acos(std::clamp(std::abs(q.w()), 0.0, 1.0));
  value_row("turned by", fmt::format("{:.1f}°", angle * 180 / std::numbers::pi));
  vector_row("velocity [m/s]", body.v, 3);
  vector_row("spin [rad/s]", body.omega, 3);
  if (info.type == BodyType::dynamic) {
    value_row("kinetic energy", quantity_text(kinetic_energy(body, info), "J"));
    const double height_energy = -info.mass * context.model.frame->gravity.dot(body.pose.x);
    value_row("energy of height", quantity_text(height_energy, "J"));
    value_row("state", body.asleep ? "asleep" : "awake",
              body.asleep ? palette::faint : palette::green);
  }
}

/// Shown until the definition of the body is known.
void draw_shapes(PanelContext& context, const BodyInfo& info) {
  section(context, info.shapes.size() == 1 ? "Shape" : "Shapes");
  constexpr size_t most = 4;
  for (size_t i = 0; i < std::min(info.shapes.size(), most); ++i) {
    const BodyShape& part = info.shapes[i];
    note(part.shape->words());
    ImGui::Indent(10);
    small_text(
        context,
        fmt::format("friction {:.3g}   restitution {:.3g}   {:.5g} kg/m³", part.material.friction,
                    part.material.restitution, part.material.density),
        palette::faint);
    if (part.material.rolling_friction || part.material.torsional_friction)
      small_text(context,
                 fmt::format("against rolling {:.3g} m   against spinning {:.3g} m",
                             part.material.rolling_arm(), part.material.torsional_arm()),
                 palette::faint);
    ImGui::Unindent(10);
  }
  if (info.shapes.size() > most)
    small_text(context, fmt::format("and {} more", info.shapes.size() - most), palette::faint);
}

std::string gap_text(double gap) {
  const double mm = gap * 1000;
  return fmt::format("{:+.2f} mm", std::abs(mm) < 0.005 ? 0.0 : mm);
}

void draw_contact(PanelContext& context, const ContactFrame& c, BodyId other, size_t index) {
  const Frame& frame = *context.model.frame;
  const auto slot = find_slot(frame, other);
  ImGui::TableNextColumn();
  std::string name = slot ? frame.info(*slot).name : std::string("gone");
  if (name.empty()) name = fmt::format("body {}", other.index);
  name = shortened(name, ImGui::GetContentRegionAvail().x);
  if (ImGui::Selectable(name.c_str()) && slot) context.ask(SelectBody{other});
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, c.gap < -5e-6 ? palette::red : palette::dim);
  ImGui::TextUnformatted(gap_text(c.gap).c_str());
  ImGui::PopStyleColor();
  ImGui::TableNextColumn();
  if (ImGui::Selectable(quantity_text(c.impulse.norm() / frame.rate.tick(), "N").c_str()))
    context.ask(SelectContact{ContactPick{c.a, c.b, c.x_world}});
  context.host.mark(fmt::format("inspector.contact.{}", index));
  tooltip_with_key(context,
                   fmt::format("impulse {} N s in this tick; click to look into the contact",
                               vector_text(c.impulse, 4)),
                   {});
}

/// Contacts are found in a tick: at its end, but before changes that were made since.
bool contacts_are_known(const UiModel& model) {
  const uint64_t tick = model.frame->tick;
  return tick > 0 && std::ranges::find(model.undo_step_ticks, tick) == model.undo_step_ticks.end();
}

/// Rows for as many contacts as this body has had since it was selected, one at least: what is
/// below does not move when the first contact comes or goes, nor again and again while the scene
/// runs.
int contact_rows(BodyId id, size_t now) {
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID body = ImGui::GetID("##contacts.body"), rows = ImGui::GetID("##contacts.rows");
  constexpr int least = 2, most = 4;  // with the heading
  if (storage.GetInt(body, -1) != int(id.index)) storage.SetInt(rows, least);
  storage.SetInt(body, int(id.index));
  const int wanted = int(std::clamp<size_t>(now + 1, least, most));
  storage.SetInt(rows, std::max(storage.GetInt(rows), wanted));
  return storage.GetInt(rows);
}

/// Draws the contacts in a height that only grows while the body is selected.
void draw_contacts(PanelContext& context, const Frame& frame, BodyId id) {
  std::vector<const ContactFrame*> own;
  frame.for_contacts([&](const ContactFrame& c) {
    if (c.a == id || c.b == id) own.push_back(&c);
  });
  const bool known = contacts_are_known(context.model);
  if (!known) own.clear();
  section(context, known ? fmt::format("Contacts  {}", own.size()).c_str() : "Contacts");
  constexpr size_t most = 50;
  const float row = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  ImGui::BeginChild("##contacts", ImVec2(0, float(contact_rows(id, own.size())) * row));
  if (own.empty()) note(known ? "touches nothing" : "not known until the next tick");
  if (!known) context.host.mark("inspector.contacts.unknown");
  if (!own.empty() && ImGui::BeginTable("##contacts", 3, ImGuiTableFlags_SizingStretchSame)) {
    for (const char* title : {"with", "gap", "force"}) {
      ImGui::TableNextColumn();
      small_text(context, title, palette::faint);
    }
    for (size_t i = 0; i < std::min(own.size(), most); ++i) {
      ImGui::PushID(int(i));
      draw_contact(context, *own[i], own[i]->a == id ? own[i]->b : own[i]->a, i);
      ImGui::PopID();
    }
    ImGui::EndTable();
  }
  if (own.size() > most)
    small_text(context, fmt::format("and {} more", own.size() - most), palette::faint);
  ImGui::EndChild();
}

/// The body, the world or the particles at an end of a spring.
std::string end_text(const Frame& frame, const Anchor& end) {
  if (end.kind == Anchor::Kind::particle) return "a particle";
  const auto slot =
      end.kind == Anchor::Kind::body ? find_slot(frame, end.body) : std::optional<uint32_t>();
  return slot ? frame.info(*slot).name : "the world";
}

/// Draws the springs that hang on the body, as long and as strong as they are now.
void draw_springs(PanelContext& context, const Frame& frame, BodyId id) {
  const auto is_own = [&](const Anchor& end) {
    return end.kind == Anchor::Kind::body && end.body == id;
  };
  size_t index = 0;
  for (const ForceFrame& force : frame.forces) {
    const auto* spring = std::get_if<SpringDef>(&force.def);
    if (!spring || !(is_own(spring->a) || is_own(spring->b))) continue;
    if (index == 0) section(context, "Springs");
    const Anchor& other = is_own(spring->a) ? spring->b : spring->a;
    const std::string title = fmt::format("spring to {}###spring{}", end_text(frame, other), index);
    const bool open = ImGui::CollapsingHeader(title.c_str());
    context.host.mark(fmt::format("inspector.spring.{}", index++));
    if (!open || force.points.size() < 2) continue;
    const double length = (force.points[1] - force.points[0]).norm();
    value_row("length", quantity_text(length, "m"));
    value_row("at rest", quantity_text(spring->rest_length.value, "m"));
    value_row("stiffness", quantity_text(spring->stiffness.value, "N/m"));
    value_row("damping", quantity_text(spring->damping.value, "N s/m"));
    const bool single = other.kind == Anchor::Kind::body && !(other.body == id);
    if (single && ImGui::Button("Select the other end")) context.ask(SelectBody{other.body});
    if (single) context.host.mark(fmt::format("inspector.spring.{}.other", index - 1));
  }
}

void draw_buttons(PanelContext& context, BodyId id) {
  if (ImGui::Button("Look at it")) context.ask(FocusBody{id});
  context.host.mark("inspector.focus");
  ImGui::SameLine();
  if (ImGui::Button("Copy")) context.ask(Action::duplicate);
  context.host.mark("inspector.copy");
  tooltip_with_key(context, "a copy beside it, or as the last copy was moved",
                   shortcut_of(Action::duplicate));
  ImGui::SameLine();
  if (ImGui::Button("Delete")) context.ask(Action::delete_body);
  context.host.mark("inspector.delete");
  tooltip_with_key(context, "delete this body", shortcut_of(Action::delete_body));
}

/// All that the file can say of a body: its course, repetition, what is drawn, and the like.
void draw_way_to_description(PanelContext& context, const std::string& name) {
  if (ImGui::Button("All that the scene says of it ...")) {
    context.state.described = ScenePath{} / "bodies" / name.substr(0, name.find('['));
    context.state.shows(PanelId::description) = true;
  }
  context.host.mark("inspector.describe");
  tooltip_with_key(context, "every value of the file: course, copies, what is drawn, label",
                   shortcut_of(Action::toggle_description));
}

}  // namespace

void draw_inspector_panel(PanelContext& context) {
  const Frame& frame = *context.model.frame;
  const auto slot = find_slot(frame, context.model.selected);
  if (!slot) {
    note("Click a body to see its mass, motion and contacts.");
    return;
  }
  const BodyFrame& body = frame.body(*slot);
  const BodyInfo& info = frame.info(*slot);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 3));
  const std::string name = info.name.empty() ? fmt::format("body {}", body.id.index) : info.name;
  const float y = ImGui::GetCursorPosY();
  const float type_width = ImGui::CalcTextSize(type_text(info).data()).x;
  value_row("", type_text(info), palette::dim);
  const float below = ImGui::GetCursorPosY();
  ImGui::SetCursorPosY(y);
  ImGui::PushFont(context.host.fonts().strong);
  ImGui::TextUnformatted(
      shortened(name, ImGui::GetContentRegionAvail().x - type_width - 12).c_str());
  ImGui::PopFont();
  ImGui::SetCursorPosY(below);
  if (context.model.selected_count > 1)
    note(fmt::format("and {} more selected", context.model.selected_count - 1));
  if (info.type == BodyType::dynamic) {
    value_row("mass", fmt::format("{:.6g} kg", info.mass));
    const Mat3& i = info.inertia;
    value_row("inertia [kg m²]", fmt::format("{:.3g}  {:.3g}  {:.3g}", i(0, 0), i(1, 1), i(2, 2)));
    const Vec3 products(i(0, 1), i(0, 2), i(1, 2));
    if (products.cwiseAbs().maxCoeff() > 1e-6 * i.diagonal().maxCoeff())
      value_row("  xy, xz, yz",
                fmt::format("{:.3g}  {:.3g}  {:.3g}", products.x(), products.y(), products.z()));
  }
  draw_motion(context, body, info);
  ImGui::Dummy(ImVec2(0, 2));
  draw_buttons(context, body.id);
  draw_way_to_description(context, info.name);
  draw_contacts(context, frame, body.id);
  draw_joint_form(context);
  draw_springs(context, frame, body.id);
  if (context.model.selected_def) {
    draw_body_form(context, body, *context.model.selected_def);
  } else {
    draw_shapes(context, info);
  }
  ImGui::PopStyleVar();
}

}  // namespace tumble
