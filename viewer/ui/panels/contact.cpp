#include "engine/math/rotation.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

std::string name_of(const Frame& frame, BodyId id) {
  const auto slot = find_slot(frame, id);
  if (!slot) return "gone";
  const std::string& name = frame.info(*slot).name;
  return name.empty() ? fmt::format("body {}", id.index) : name;
}

uint32_t colour_of(ContactMode mode) {
  switch (mode) {
    case ContactMode::open:
      return palette::dim;
    case ContactMode::sticking:
      return palette::green;
    case ContactMode::sliding:
      return palette::accent;
  }
  return palette::dim;
}

/// "upper on lower": both names as links to their bodies.
void draw_names(PanelContext& context, const ContactView& view) {
  const Frame& frame = *context.model.frame;
  const float width = 0.5f * (ImGui::GetContentRegionAvail().x - 40);
  const auto link = [&](BodyId id, const char* mark) {
    const std::string name = shortened(name_of(frame, id), width);
    if (ImGui::Selectable(name.c_str(), false, 0, ImVec2(ImGui::CalcTextSize(name.c_str()).x, 0)) &&
        find_slot(frame, id))
      context.ask(SelectBody{id});
    context.host.mark(mark);
  };
  ImGui::PushFont(context.host.fonts().strong);
  ImGui::PushID("b");
  link(view.pick.b, "contact.b");
  ImGui::PopID();
  ImGui::SameLine(0, 6);
  small_text(context, "on", palette::faint);
  ImGui::SameLine(0, 6);
  ImGui::PushID("a");
  link(view.pick.a, "contact.a");
  ImGui::PopID();
  ImGui::PopFont();
}

/// The friction cone seen along the normal: its rim is the circle, the dot the contact force.
void draw_cone(PanelContext& context, const ContactCertificate& c, float size) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::Dummy(ImVec2(size, size));
  context.host.mark("contact.cone");
  const float radius = 0.5f * size - 6;
  const ImVec2 centre(at.x + 0.5f * size, at.y + 0.5f * size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled(centre, radius, palette::well, 48);
  list.AddCircle(centre, 0.5f * radius, palette::line, 40);
  list.AddLine({centre.x - radius, centre.y}, {centre.x + radius, centre.y}, palette::line);
  list.AddLine({centre.x, centre.y - radius}, {centre.x, centre.y + radius}, palette::line);
  list.AddCircle(centre, radius, palette::dim, 48, 1.5f);
  const double pressing = c.normal.dot(c.force);
  if (!(pressing > 0) || !(c.friction > 0)) return;
  Vec3 u, v;
  tangent_frame(c.normal, u, v);
  Vec2 place = Vec2(u.dot(c.force), v.dot(c.force)) / (c.friction * pressing);
  if (!place.allFinite()) return;
  if (place.norm() > 1) place.normalize();
  const ImVec2 end(centre.x + radius * float(place.x()), centre.y - radius * float(place.y()));
  list.AddLine(centre, end, colour_of(c.mode), 2);
  list.AddCircleFilled(end, 4.5f, colour_of(c.mode), 16);
}

void draw_friction(PanelContext& context, const ContactCertificate& c) {
  section(context, "Force and friction");
  constexpr float cone = 84;
  const float y = ImGui::GetCursorPosY();
  draw_cone(context, c, cone);
  const float below = ImGui::GetCursorPosY();
  ImGui::SetCursorPosY(y + 2);
  ImGui::Indent(cone + 6);
  const double pressing = c.normal.dot(c.force);
  value_row("normal", quantity_text(pressing, "N"));
  value_row("friction", quantity_text((c.force - pressing * c.normal).norm(), "N"));
  value_row("of the cone", c.friction > 0 ? fmt::format("{:.1f} %", 100 * c.place_in_cone) : "–");
  value_row("coefficient", fmt::format("{:.4g}", c.friction));
  ImGui::Unindent(cone + 6);
  ImGui::SetCursorPosY(std::max(below, ImGui::GetCursorPosY()));
  value_row("slip", quantity_text(c.slip_velocity.norm(), "m/s"));
}

void draw_gap(PanelContext& context, const ContactCertificate& c, bool accelerations) {
  section(context, "Gap");
  value_row(c.gap < -5e-10 ? "overlap" : "gap", quantity_text(std::abs(c.gap), "m"),
            c.gap + c.offset < -1e-5 ? palette::red : 0);
  value_row("accepted overlap", quantity_text(c.offset, "m"));
  value_row("opens at", quantity_text(c.normal_velocity, "m/s"));
  if (accelerations) value_row("and gains", quantity_text(c.normal_acceleration, "m/s²"));
}

/// Residuals with two figures and the exponent: "3.1e-16".
std::string residual_text(double value) {
  return value == 0 ? "0" : fmt::format("{:.1e}", value);
}

void draw_answer(PanelContext& context, const ContactCertificate& c) {
  section(context, "Answer");
  value_row("solver", c.solver.empty() ? std::string_view("none was needed") : c.solver);
  value_row("residual", residual_text(c.residual), c.residual > 1e-9 ? palette::red : 0);
  value_row("complementarity", residual_text(c.complementarity));
}

void draw_balance(PanelContext& context, BodyId id, const BodyBalance& b) {
  const std::string title = "Balance of " + name_of(*context.model.frame, id);
  section(context, shortened(title, ImGui::GetContentRegionAvail().x).c_str());
  const auto row = [&](const char* label, const Vec3& force, const Vec3& torque) {
    value_row(label, vector_text(force, 2) + " N");
    tooltip_with_key(context, fmt::format("torque {} N m", vector_text(torque, 3)), {});
  };
  row("other forces", b.smooth_force, b.smooth_torque);
  row("contacts", b.contact_force, b.contact_torque);
  row("mass × acc.", b.momentum_rate, b.angular_rate);
  value_row("left over, of all", residual_text(b.residual),
            b.residual > 1e-9 ? palette::red : palette::green);
}

}  // namespace

void draw_contact_panel(PanelContext& context) {
  const ContactView* view = context.model.contact;
  if (!view) return note("Asking the world …");
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 3));
  draw_names(context, *view);
  if (!view->refusal.empty()) {
    note(view->refusal);
  } else if (!view->certificate) {
    note("The two do not touch now. If they touch again, this is the place.");
  } else {
    const ContactCertificate& c = *view->certificate;
    const bool exact = c.solver != "realtime";
    small_text(context, to_string(c.mode), colour_of(c.mode));
    draw_gap(context, c, exact);
    draw_friction(context, c);
    draw_answer(context, c);
    if (view->balance_b) draw_balance(context, view->pick.b, *view->balance_b);
    if (view->balance_a) draw_balance(context, view->pick.a, *view->balance_a);
    if (!exact)
      note(
          "Means over the last tick. The stepper 'event' also tells accelerations and the balance "
          "of forces.");
  }
  ImGui::PopStyleVar();
}

}  // namespace tumble
