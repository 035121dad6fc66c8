#include "viewer/ui/widgets.hpp"

#include "viewer/ui/style.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

void draw_icon(ImDrawList& list, Icon icon, ImVec2 c, float r, ImU32 colour) {
  const auto triangle = [&](float x, float w, float h) {
    list.AddTriangleFilled({c.x + x - w, c.y - h}, {c.x + x + w, c.y}, {c.x + x - w, c.y + h},
                           colour);
  };
  const auto bar = [&](float x, float w, float h) {
    list.AddRectFilled({c.x + x - w, c.y - h}, {c.x + x + w, c.y + h}, colour, 1.0f);
  };
  const auto mirrored = [&](float x, float w, float h) {
    list.AddTriangleFilled({c.x + x + w, c.y - h}, {c.x + x - w, c.y}, {c.x + x + w, c.y + h},
                           colour);
  };
  switch (icon) {
    case Icon::play:
      triangle(0.12f * r, 0.62f * r, 0.8f * r);
      break;
    case Icon::pause:
      bar(-0.4f * r, 0.2f * r, 0.75f * r);
      bar(0.4f * r, 0.2f * r, 0.75f * r);
      break;
    case Icon::step_forward:
      triangle(-0.2f * r, 0.48f * r, 0.66f * r);
      bar(0.55f * r, 0.13f * r, 0.66f * r);
      break;
    case Icon::step_back:
      mirrored(0.2f * r, 0.48f * r, 0.66f * r);
      bar(-0.55f * r, 0.13f * r, 0.66f * r);
      break;
    case Icon::restart: {
      list.PathArcTo(c, 0.62f * r, -0.9f, 3.9f, 24);
      list.PathStroke(colour, 0, 0.22f * r);
      const float a = -0.9f;
      const ImVec2 tip(c.x + 0.62f * r * std::cos(a), c.y + 0.62f * r * std::sin(a));
      list.AddTriangleFilled({tip.x - 0.52f * r, tip.y + 0.02f * r},
                             {tip.x + 0.18f * r, tip.y - 0.45f * r},
                             {tip.x + 0.2f * r, tip.y + 0.3f * r}, colour);
      break;
    }
    case Icon::close:
      list.AddLine({c.x - 0.45f * r, c.y - 0.45f * r}, {c.x + 0.45f * r, c.y + 0.45f * r}, colour,
                   1.5f);
      list.AddLine({c.x - 0.45f * r, c.y + 0.45f * r}, {c.x + 0.45f * r, c.y - 0.45f * r}, colour,
                   1.5f);
      break;
    case Icon::search:
      list.AddCircle({c.x - 0.12f * r, c.y - 0.12f * r}, 0.48f * r, colour, 20, 1.5f);
      list.AddLine({c.x + 0.24f * r, c.y + 0.24f * r}, {c.x + 0.68f * r, c.y + 0.68f * r}, colour,
                   1.8f);
      break;
    case Icon::record:
      list.AddCircleFilled(c, 0.5f * r, colour, 20);
      break;
  }
}

/// The x of a tooltip's centre below a bar, nearest to `middle`, at which it covers no close button
/// of a panel.
float beside_crosses(const UiHost& host, float middle, float half, float y, float height) {
  for (const auto& [name, cross] : host.widgets()) {
    const float left = cross.x - half, right = cross.x + cross.width + half;
    if (!name.ends_with(".close") || cross.y > y + height || cross.y + cross.height < y ||
        middle < left || middle > right)
      continue;
    const bool room = right + half < ImGui::GetIO().DisplaySize.x;
    return room && right - middle < middle - left ? right : left;
  }
  return middle;
}

/// Places a tooltip beside the panel of the last item, towards the middle of the picture, so that
/// it does not cover the panel; below a bar, so that the other buttons stay visible; or, if there
/// is no room, near the pointer.
void place_tooltip(const UiHost& host, float width) {
  constexpr float gap = 6;
  const float left = ImGui::GetWindowPos().x, right = left + ImGui::GetWindowWidth();
  const float picture = ImGui::GetIO().DisplaySize.x;
  if (left <= 0 && right >= picture) {
    const float middle = 0.5f * (ImGui::GetItemRectMin().x + ImGui::GetItemRectMax().x);
    const float least = 0.5f * width + gap, most = std::max(picture - least, least);
    const float below = ImGui::GetWindowPos().y + ImGui::GetWindowHeight() + gap;
    const float height = ImGui::GetTextLineHeight() + 2 * gap;
    const float at =
        beside_crosses(host, std::clamp(middle, least, most), 0.5f * width + gap, below, height);
    ImGui::SetNextWindowPos({std::max(at, least), below}, ImGuiCond_Always, {0.5f, 0.0f});
    return;
  }
  const float y = 0.5f * (ImGui::GetItemRectMin().y + ImGui::GetItemRectMax().y);
  const bool at_left = left > picture - right;
  if ((at_left ? left : picture - right) < width + 2 * gap) return;
  ImGui::SetNextWindowPos({at_left ? left - gap : right + gap, y}, ImGuiCond_Always,
                          {at_left ? 1.0f : 0.0f, 0.5f});
}

std::string fixed_text(double x, int decimals) {
  // -0.00 is shown as 0.00
  if (std::abs(x) < 0.5 * std::pow(10.0, -decimals)) x = 0;
  return fmt::format("{:.{}f}", x, decimals);
}

}  // namespace

void tooltip_with_key(PanelContext& context, std::string_view text, std::string_view shortcut) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  constexpr float padding = 9, before_key = 12;
  const auto width_of = [](std::string_view t) {
    return ImGui::CalcTextSize(t.data(), t.data() + t.size()).x;
  };
  place_tooltip(context.host, width_of(text) + 2 * padding +
                                  (shortcut.empty() ? 0 : before_key + width_of(shortcut)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, 6));
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  if (!shortcut.empty()) {
    ImGui::SameLine(0, before_key);
    small_text(context, shortcut, palette::accent);
  }
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  context.host.mark("tooltip", {at.x, at.y, size.x, size.y});
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

bool icon_button(PanelContext& context, std::string_view name, Icon icon, std::string_view tooltip,
                 std::string_view shortcut, float size, bool lit) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool clicked = ImGui::InvisibleButton(std::string(name).c_str(), ImVec2(size, size));
  context.host.mark(name);
  const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end(at.x + size, at.y + size);
  if (lit)
    list.AddRectFilled(at, end, hovered ? palette::accent_strong : palette::accent, 6);
  else if (hovered || active)
    list.AddRectFilled(at, end, active ? palette::pressed : palette::hover, 6);
  const float alpha = ImGui::GetStyle().Alpha;
  const ImU32 colour = lit                   ? palette::faded(palette::on_accent, alpha)
                       : hovered             ? palette::faded(palette::text, alpha)
                       : icon == Icon::close ? palette::faded(palette::dim, alpha)
                                             : palette::faded(palette::text, alpha);
  draw_icon(list, icon, {at.x + 0.5f * size, at.y + 0.5f * size}, 0.3f * size, colour);
  tooltip_with_key(context, tooltip, shortcut);
  return clicked;
}

bool word_button(PanelContext& context, std::string_view name, const char* text, bool lit,
                 std::string_view tooltip, std::string_view shortcut, float height) {
  ImGui::PushID(std::string(name).c_str());
  ImGui::PushStyleColor(ImGuiCol_Button, lit ? palette::accent_soft : 0u);
  ImGui::PushStyleColor(ImGuiCol_Text, lit ? palette::accent : palette::dim);
  const bool clicked = ImGui::Button(text, ImVec2(0, height));
  ImGui::PopStyleColor(2);
  context.host.mark(name);
  tooltip_with_key(context, tooltip, shortcut);
  ImGui::PopID();
  return clicked;
}

bool panel_heading(PanelContext& context, const PanelEntry& panel) {
  const bool large = panel.dock == Dock::centre;
  const bool of_mesh = panel.id == PanelId::scenes && context.state.choosing_mesh;
  const std::string_view title = of_mesh ? "Choose a mesh" : panel.title;
  ImGui::PushFont(large ? context.host.fonts().large : context.host.fonts().strong);
  ImGui::TextUnformatted(title.data(), title.data() + title.size());
  ImGui::PopFont();
  const float size = 20;
  const std::string shortcut = panel.toggle ? shortcut_of(*panel.toggle) : std::string();
  ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::GetStyle().WindowPadding.x - size + 4);
  const bool closed = icon_button(context, fmt::format("{}.close", panel.name), Icon::close,
                                  "close", large ? "Esc" : shortcut, size);
  ImGui::Dummy(ImVec2(0, large ? 4.0f : 0.0f));
  return closed;
}

void section(PanelContext& context, const char* title) {
  ImGui::Dummy(ImVec2(0, 3));
  small_text(context, title, palette::accent);
}

void value_row(std::string_view label, std::string_view value, uint32_t colour) {
  ImGui::PushStyleColor(ImGuiCol_Text, palette::dim);
  ImGui::TextUnformatted(label.data(), label.data() + label.size());
  ImGui::PopStyleColor();
  const float width = ImGui::CalcTextSize(value.data(), value.data() + value.size()).x;
  const float right = ImGui::GetContentRegionMax().x;
  ImGui::SameLine(std::max(right - width, ImGui::GetCursorPosX()));
  if (colour) ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(value.data(), value.data() + value.size());
  if (colour) ImGui::PopStyleColor();
}

void vector_row(std::string_view label, const Vec3& v, int decimals) {
  const auto width_of = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
  // Room for a sign and two digits before the point; if space is short, the numbers are set closer.
  const float place = width_of("  " + fixed_text(-88, decimals));
  const std::string numbers[] = {fixed_text(v.x(), decimals), fixed_text(v.y(), decimals),
                                 fixed_text(v.z(), decimals)};
  float widest = 0;
  for (const std::string& n : numbers) widest = std::max(widest, width_of("  " + n));
  const float right = ImGui::GetContentRegionMax().x;
  const float label_end = ImGui::GetCursorPosX() + width_of(std::string(label));
  if (widest > place || label_end > right - 3 * place)
    return value_row(label, vector_text(v, decimals));
  ImGui::PushStyleColor(ImGuiCol_Text, palette::dim);
  ImGui::TextUnformatted(label.data(), label.data() + label.size());
  ImGui::PopStyleColor();
  for (int k = 0; k < 3; ++k) {
    ImGui::SameLine(right - float(2 - k) * place - width_of(numbers[k]));
    ImGui::TextUnformatted(numbers[k].c_str());
  }
}

bool toggle(PanelContext& context, std::string_view name, const char* label, bool& on,
            std::string_view hint) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = 24;
  const bool clicked = ImGui::InvisibleButton(std::string(name).c_str(), ImVec2(width, height));
  context.host.mark(name);
  if (clicked) on = !on;
  const bool hovered = ImGui::IsItemHovered();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float w = 30, h = 16, y = at.y + 0.5f * (height - h);
  list.AddRectFilled({at.x, y}, {at.x + w, y + h},
                     on ? palette::accent : (hovered ? palette::pressed : palette::raised),
                     0.5f * h);
  list.AddCircleFilled({at.x + (on ? w - 0.5f * h : 0.5f * h), y + 0.5f * h}, 0.5f * h - 2.5f,
                       on ? palette::on_accent : palette::dim, 20);
  const float text_y = at.y + 0.5f * (height - ImGui::GetTextLineHeight());
  list.AddText({at.x + w + 10, text_y}, on || hovered ? palette::text : palette::dim, label);
  if (!hint.empty()) {
    const float hint_width = ImGui::CalcTextSize(hint.data(), hint.data() + hint.size()).x;
    list.AddText({at.x + width - hint_width, text_y}, palette::faint, hint.data(),
                 hint.data() + hint.size());
  }
  return clicked;
}

/// Dear ImGui would also break lines at the decimal points of numbers.
void wrapped(std::string_view text, uint32_t colour) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(in_lines(text, ImGui::GetContentRegionAvail().x).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

void note(std::string_view text) {
  wrapped(text, palette::dim);
}

void small_text(PanelContext& context, std::string_view text, uint32_t colour) {
  ImGui::PushFont(context.host.fonts().small);
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

std::string shortened(std::string_view text, float width) {
  const auto fits = [&](std::string_view part, float room) {
    return ImGui::CalcTextSize(part.data(), part.data() + part.size()).x <= room;
  };
  if (fits(text, width)) return std::string(text);
  const float room = width - ImGui::CalcTextSize("…").x;
  size_t end = 0;
  for (size_t i = 0; i < text.size();) {
    size_t next = i + 1;  // after a whole UTF-8 character
    while (next < text.size() && (text[next] & 0xC0) == 0x80) ++next;
    if (!fits(text.substr(0, next), room)) break;
    if (text[i] != ' ') end = next;
    i = next;
  }
  return std::string(text.substr(0, end)) + "…";
}

std::string in_lines(std::string_view text, float width) {
  std::string out;
  size_t line = 0;  // beginning of the last line
  while (true) {
    const size_t end = text.find_first_of(" \n"), before = out.size();
    out += text.substr(0, end);
    if (before > line &&
        ImGui::CalcTextSize(out.data() + line, out.data() + out.size()).x > width) {
      out[before - 1] = '\n';
      line = before;
    }
    if (end == std::string_view::npos) return out;
    out += text[end];
    if (text[end] == '\n') line = out.size();
    text.remove_prefix(end + 1);
  }
}

std::string duration_text(double s) {
  if (!(s > 0)) return "0 ms";
  if (s < 1e-3) return fmt::format("{:.0f} µs", s * 1e6);
  if (s < 0.1) return fmt::format("{:.2f} ms", s * 1e3);
  if (s < 1) return fmt::format("{:.0f} ms", s * 1e3);
  return fmt::format("{:.2f} s", s);
}

namespace {

struct Prefix {
  double scale;
  std::string_view name;
};
/// The SI prefix with which a size has one to three digits before the point.
Prefix prefix_of(double size) {
  constexpr Prefix prefixes[] = {{1e9, "G"}, {1e6, "M"},  {1e3, "k"},
                                 {1, ""},    {1e-3, "m"}, {1e-6, "µ"}};
  for (const Prefix& p : prefixes)
    if (size >= 0.9999995 * p.scale) return p;
  return {1e-6, "µ"};
}

}  // namespace

std::string quantity_text(double value, std::string_view unit) {
  if (!std::isfinite(value)) return "undefined";
  const double size = std::abs(value);
  if (size < 5e-10) return fmt::format("0 {}", unit);
  const Prefix p = prefix_of(size);
  const double scaled = value / p.scale, digits = std::abs(scaled);
  const int decimals = digits >= 99.995 ? 1 : digits >= 9.9995 ? 2 : 3;
  return fmt::format("{:.{}f} {}{}", scaled, decimals, p.name, unit);
}

std::string round_text(double value, std::string_view unit) {
  if (value == 0) return "0";
  const Prefix p = prefix_of(std::abs(value));
  return fmt::format("{:.4g} {}{}", value / p.scale, p.name, unit);
}

std::string vector_text(const Vec3& v, int decimals) {
  return fmt::format("{}  {}  {}", fixed_text(v.x(), decimals), fixed_text(v.y(), decimals),
                     fixed_text(v.z(), decimals));
}

}  // namespace tumble
