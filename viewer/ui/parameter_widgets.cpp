#include "viewer/ui/parameter_widgets.hpp"

#include "engine/scene/visitors/known_names.hpp"
#include "engine/scene/visitors/value_text.hpp"
#include "engine/world/settings.hpp"
#include "viewer/ui/style.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tumble {
namespace {

/// Why a value is invalid; "": it is valid.
std::string fault_of(double v, const Parameter& p) {
  return range_fault(v, p);
}
std::string fault_of(const Vec3& v, const Parameter& p) {
  for (int k = 0; k < 3; ++k)
    if (std::string fault = range_fault(v[k], p); !fault.empty()) return fault;
  return {};
}

/// The number to display: -0 as 0, and angles without the residue of rounding.
double shown_number(double v, const Parameter& p) {
  constexpr double rounding = 1e-9;  // [deg]
  const bool angle = p.name.ends_with("_deg") || p.unit == "deg";
  return angle && std::abs(v) < rounding ? 0.0 : v + 0.0;
}

/// How long the reason for rejecting a value is shown [s].
constexpr double fault_seconds = 6;

/// Share of a line's width for labels.
constexpr float label_share = 0.56f;

/// Width of the button that pins a value [UI units].
constexpr float pin_width = 14;

}  // namespace

Vec3 shown_vector(const Vec3& v, std::string_view unit, double size) {
  constexpr double rounding = 1e-5;  // below the digits that are shown, and below a pixel
  const bool linear = unit == "m" || unit == "m/s", angular = unit == "rad/s";
  const double scale = std::max(v.cwiseAbs().maxCoeff(), linear ? size : angular ? 1.0 : 0.0);
  Vec3 out;
  for (int k = 0; k < 3; ++k) out[k] = std::abs(v[k]) < rounding * scale ? 0.0 : v[k] + 0.0;
  return out;
}

std::string label_of(std::string_view name) {
  if (name == "tick_hz") return "tick rate";
  if (name == "sleep_speed") return "sleep speed / sqrt(g r)";
  if (name == "mode") return "collides as";  // of a mesh
  if (name == "euler_deg") return "turned about x, y, z";
  if (name.ends_with("_deg")) name.remove_suffix(4);
  std::string label(name);
  for (char& c : label)
    if (c == '_' || c == '.') c = ' ';  // the point separates the index within a list
  return label;
}

std::string label_of_pin(const Pin& pin) {
  const size_t point = pin.value.rfind('.');
  std::string out = (pin.joint.empty() ? pin.body : pin.joint) + ": ";
  if (point == std::string::npos) return out + label_of(pin.value);
  return out + label_of(pin.value.substr(0, point)) + " " + label_of(pin.value.substr(point + 1));
}

std::optional<std::string> typed_text(PanelContext& context, const std::string& mark,
                                      const std::string& now, float width) {
  TypedValue& typing = context.state.typing;
  std::string text = now;
  ImGui::SetNextItemWidth(width);
  ImGui::InputText(("##" + mark).c_str(), &text, ImGuiInputTextFlags_AutoSelectAll);
  context.host.mark(mark);
  if (ImGui::IsItemActive()) typing = {mark, text};
  if (!ImGui::IsItemDeactivated() || typing.field != mark) return std::nullopt;
  std::string last = std::exchange(typing, {}).text;
  if (ImGui::IsKeyPressed(ImGuiKey_Escape, false)) return std::nullopt;
  // Left by Enter it has given the text, left by a click elsewhere it has forgotten it already.
  if (text != now) last = std::move(text);
  return last == now ? std::nullopt : std::optional(std::move(last));
}

std::optional<std::string> name_list(PanelContext& context, const std::string& mark,
                                     std::span<const std::string> names) {
  std::optional<std::string> chosen;
  ImGui::SameLine(0, 0);
  if (ImGui::BeginCombo(("##names" + mark).c_str(), nullptr,
                        ImGuiComboFlags_NoPreview | ImGuiComboFlags_PopupAlignLeft)) {
    for (const std::string& name : names) {
      if (ImGui::Selectable(name.c_str())) chosen = name;
      context.host.mark(mark + "." + name);
    }
    ImGui::EndCombo();
  }
  context.host.mark(mark + ".names");
  return chosen;
}

std::string words_of(std::string_view name) {
  struct Proper {
    std::string_view key, word;
  };
  constexpr Proper proper[] = {
      {"gjk", "GJK"},     {"aabb", "AABB"},   {"obb", "OBB"},         {"sat", "SAT"},
      {"rk2", "RK2"},     {"rk4", "RK4"},     {"rk45", "RK45"},       {"sdf", "SDF"},
      {"epa", "EPA"},     {"dfsph", "DFSPH"}, {"dantzig", "Dantzig"}, {"baraff", "Baraff"},
      {"euler", "Euler"}, {"v", "V"},         {"clip", "Clip"},       {"lemke", "Lemke"}};
  std::string out;
  while (!name.empty()) {
    const size_t end = std::min(name.find('_'), name.size());
    const std::string_view word = name.substr(0, end);
    const auto known = std::ranges::find(proper, word, &Proper::key);
    if (!out.empty()) out += word == "clip" && out == "V" ? '-' : ' ';
    out += known == std::end(proper) ? word : known->word;
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return out;
}

std::string unit_words(std::string_view unit) {
  std::string out;
  for (size_t i = 0; i < unit.size(); ++i) {
    const bool power = i > 0 && std::isalpha(static_cast<unsigned char>(unit[i - 1]));
    if (power && unit[i] == '2')
      out += "²";
    else if (power && unit[i] == '3')
      out += "³";
    else
      out += unit[i];
  }
  return out;
}

bool ParameterWidgets::slider(double& value, const Parameter& p, const char* format) {
  auto& ranges = context_.state.pins.ranges;
  SliderRange& range = ranges[mark_name(p)];
  if (range.most <= range.least || value < range.least || value > range.most)
    range = slider_range(value, p.min, p.max);
  const bool pulled =
      ImGui::SliderScalar(id(p), ImGuiDataType_Double, &value, &range.least, &range.most, format);
  if (ImGui::IsItemDeactivated()) ranges.erase(mark_name(p));  // the next pull reaches farther
  return pulled;
}

void ParameterWidgets::field(double& value, const Parameter& p) {
  if (skips(p)) return;
  begin(p, only_.has_value(), true);
  double v = shown_number(value, p);
  const float speed = float(std::max(std::abs(v) * 0.01, 1e-3));
  const std::string format =
      p.unit.empty() || only_ ? "%.4g" : fmt::format("%.4g {}", unit_words(p.unit));
  const bool pulled = only_ ? slider(v, p, format.c_str())
                            : ImGui::DragScalar(id(p), ImGuiDataType_Double, &v, speed, nullptr,
                                                nullptr, format.c_str());
  if (pulled && takes(fault_of(v, p), p)) value = v;
  end(p);
}

void ParameterWidgets::field(int& value, const Parameter& p) {
  if (skips(p)) return;
  begin(p, only_.has_value(), true);
  int v = value;
  if (ImGui::DragInt(id(p), &v, 0.1f, int(std::max(p.min, -1e6)), int(std::min(p.max, 1e6))) &&
      takes(fault_of(v, p), p))
    value = v;
  end(p);
}

void ParameterWidgets::field(bool& value, const Parameter& p) {
  if (only_) return;
  if (toggle(context_, mark_name(p), label_of(p.name).c_str(), value)) note_change(p);
  tooltip_with_key(context_, p.doc, {});
}

void ParameterWidgets::field(Vec3& value, const Parameter& p) {
  if (skips(p)) return;
  begin(p, true, true);
  Vec3 v = shown_vector(value, p.unit, size_);
  for (int k = 0; k < 3; ++k) v[k] = shown_number(v[k], p);
  const Vec3 shown = v;
  const float speed = float(std::max(v.cwiseAbs().maxCoeff() * 0.01, 5e-3));
  if (ImGui::DragScalarN(id(p), ImGuiDataType_Double, v.data(), 3, speed, nullptr, nullptr,
                         "%.4g") &&
      takes(fault_of(v, p), p))
    for (int k = 0; k < 3; ++k)  // the others keep all their digits
      if (v[k] != shown[k]) value[k] = v[k];
  if (ImGui::IsItemVisible()) {
    const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
    const float third = (b.x - a.x) / 3;
    for (int k = 0; k < 3; ++k)
      context_.host.mark(fmt::format("{}.{}", mark_name(p), "xyz"[k]),
                         {a.x + third * float(k), a.y, third, b.y - a.y});
  }
  end(p);
}

void ParameterWidgets::field(TickRate& value, const Parameter& p) {
  if (only_) return;
  begin(p);
  auto hz = int(std::lround(double(value.num) / double(value.den)));
  if (ImGui::DragInt(id(p), &hz, 1, int(p.min), 2000, "%d Hz") && takes(fault_of(hz, p), p))
    value = {hz, 1};
  end(p);
}

bool ParameterWidgets::over_time(bool& on, const Parameter& p) {
  if (only_) return false;
  const std::string label = label_of(p.name) + " over time";
  if (!toggle(context_, mark_name(p) + ".over_time", label.c_str(), on)) return false;
  tooltip_with_key(context_, "follows an expression in t [s]", {});
  note_change(p);
  return true;
}

void ParameterWidgets::course(Varying& value, const Parameter& p) {
  if (only_) return;
  const TimeCourse& now = *value.course;
  if (now.text().empty())
    return value_row(label_of(p.name), fmt::format("a table of {} times", now.points().size()));
  begin(p, true);
  char text[256] = {};
  now.text().copy(text, sizeof text - 1);
  if (ImGui::InputText(id(p), text, sizeof text, ImGuiInputTextFlags_EnterReturnsTrue)) {
    const auto made = now.with_text(text);
    std::string fault = made ? fault_of(made->at(0), p) : made.error().message;
    if (takes(std::move(fault), p)) value = *made;
  }
  end(p);
}

void ParameterWidgets::field(Varying& value, const Parameter& p) {
  bool on = value.varies();
  on ? course(value, p) : field(value.value, p);
  if (!over_time(on, p)) return;
  if (on)
    value = *TimeCourse::expression(fmt::format("{}", value.value));
  else
    value.course = nullptr;
}

void ParameterWidgets::field(VaryingVec3& value, const Parameter& p) {
  bool on = value.varies();
  if (!on) {
    Vec3 now = value.now();
    field(now, p);
    value = now;
  }
  for (size_t k = 0; on && k < 3; ++k) {
    Parameter one = p;
    const std::string name = fmt::format("{}.{}", p.name, "xyz"[k]);
    one.name = name;
    value.of[k].varies() ? course(value.of[k], one) : field(value.of[k].value, one);
  }
  if (!over_time(on, p)) return;
  for (Varying& x : value.of) {
    if (on)
      x = *TimeCourse::expression(fmt::format("{}", x.value));
    else
      x.course = nullptr;
  }
}

void ParameterWidgets::field(Colour& value, const Parameter& p) {
  if (only_) return;
  begin(p);
  float rgb[3] = {float(value.r), float(value.g), float(value.b)};
  if (ImGui::ColorEdit3(id(p), rgb, ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel)) {
    value = {double(rgb[0]), double(rgb[1]), double(rgb[2])};
    note_change(p);
  }
  end(p);
}

void ParameterWidgets::field(std::string& value, const Parameter& p) {
  if (only_) return;
  const std::vector<std::string> names = known_names(p.name);
  if (names.empty()) return value_row(label_of(p.name), value);
  const std::vector<std::string_view> views(names.begin(), names.end());
  auto index = size_t(std::ranges::find(names, value) - names.begin());
  if (choice(index, views, p)) value = names[index];
}

bool ParameterWidgets::choice(size_t& index, std::span<const std::string_view> names,
                              const Parameter& p, std::span<const std::string_view> words) {
  const auto shown = [&](size_t i) {
    return words.empty() ? words_of(names[i]) : std::string(words[i]);
  };
  if (only_) return false;
  // If one of the fields does not fit beside the label, all are placed below it.
  float widest = 0;
  for (size_t i = 0; i < names.size(); ++i)
    widest = std::max(widest, ImGui::CalcTextSize(shown(i).c_str()).x);
  const float room = (1 - label_share) * ImGui::GetContentRegionAvail().x -
                     ImGui::GetFrameHeight() - 2 * ImGui::GetStyle().FramePadding.x;
  begin(p, widest > room);
  bool chosen = false;
  const std::string now = index < names.size() ? shown(index) : std::string();
  if (ImGui::BeginCombo(id(p), now.c_str())) {
    for (size_t i = 0; i < names.size(); ++i) {
      const bool clicked = ImGui::Selectable(shown(i).c_str(), i == index);
      context_.host.mark(fmt::format("{}.{}", mark_name(p), names[i]));
      if (!clicked || i == index) continue;
      index = i;
      chosen = true;
      note_change(p);
    }
    ImGui::EndCombo();
  }
  end(p);
  return chosen;
}

bool ParameterWidgets::skips(const Parameter& p) const {
  return only_ && pin_of(p).value != only_->value;
}

Pin ParameterWidgets::pin_of(const Parameter& p) const {
  if (!place_) return {};
  return {place_->body, place_->joint, place_->prefix + std::string(p.name)};
}

/// At the right end of the label, before the field: a pin that is seen where it is in, or where the
/// pointer is.
void ParameterWidgets::pin_button(const Parameter& p) {
  const Pin pin = pin_of(p);
  const bool in = context_.state.pins.has(pin);
  const std::string mark = mark_name(p) + ".pin";
  const float height = ImGui::GetFrameHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::InvisibleButton(mark.c_str(), {pin_width, height})) context_.state.pins.flip(pin);
  const bool near = ImGui::IsItemHovered();
  context_.host.mark(mark);
  tooltip_with_key(context_, in ? "take it off Settings" : "pin: it stands in Settings too", {});
  const ImVec2 c(at.x + 0.5f * pin_width, at.y + 0.5f * height);
  const uint32_t colour = near ? palette::accent
                          : in ? palette::dim
                               : palette::faded(palette::faint, 0.45f);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float tilt = in ? 0 : 2.5f;  // what is in stands straight
  list.AddCircleFilled({c.x + tilt, c.y - 3}, 2.6f, colour, 12);
  list.AddLine({c.x + tilt, c.y - 2}, {c.x - tilt, c.y + 5}, colour, 1.3f);
}

void ParameterWidgets::heading(const Parameter& p) {
  if (only_) return;
  ImGui::Dummy(ImVec2(0, 2));
  small_text(context_, label_of(p.name), palette::accent);
}

std::string ParameterWidgets::mark_name(const Parameter& p) const {
  return fmt::format("{}.{}", prefix_, p.name);
}

const char* ParameterWidgets::id(const Parameter& p) {
  id_ = fmt::format("##{}.{}", prefix_, p.name);
  return id_.c_str();
}

bool ParameterWidgets::takes(std::string fault, const Parameter& p) {
  RefusedValue& refused = context_.state.refused;
  if (fault.empty()) {
    if (refused.field == mark_name(p)) refused = {};
    note_change(p);
    return true;
  }
  refused = {mark_name(p), std::move(fault), ImGui::GetTime() + fault_seconds};
  return false;
}

void ParameterWidgets::note_change(const Parameter& p) {
  changed = true;
  edited = label_of(p.name);
}

void ParameterWidgets::begin(const Parameter& p, bool own_line, bool number) {
  drawn = true;
  std::string label = only_ ? label_of_pin(*only_) : label_of(p.name);
  if (own_line && !p.unit.empty()) label += fmt::format(" [{}]", unit_words(p.unit));
  const float width = ImGui::GetContentRegionAvail().x, x = ImGui::GetCursorPosX();
  const bool pinned = number && place_;
  const float end = width * (own_line ? 1 : label_share) - 4 - (pinned ? pin_width : 0);
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, palette::dim);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushClipRect(at, {at.x + end, at.y + 30}, true);
  ImGui::TextUnformatted(label.c_str());
  ImGui::PopClipRect();
  ImGui::PopStyleColor();
  tooltip_with_key(context_, p.doc, {});
  if (pinned) {
    ImGui::SameLine(x + end);
    pin_button(p);
  }
  if (!own_line) ImGui::SameLine(x + width * label_share);
  ImGui::SetNextItemWidth(own_line ? width : width * (1 - label_share));
}

void ParameterWidgets::end(const Parameter& p) {
  context_.host.mark(mark_name(p));
  tooltip_with_key(context_, p.doc, {});
  // An incomplete number may be out of range while it is being typed.
  const RefusedValue& refused = context_.state.refused;
  if (refused.field != mark_name(p) || ImGui::GetTime() > refused.until || ImGui::IsItemActive())
    return;
  ImGui::PushFont(context_.host.fonts().small);
  wrapped(label_of(p.name) + " " + refused.words, palette::red);
  ImGui::PopFont();
  context_.host.mark(mark_name(p) + ".refused");
}

}  // namespace tumble
