#include "viewer/ui/part_form.hpp"

#include "engine/scene/description.hpp"
#include "engine/scene/saving/naming_keys.hpp"
#include "engine/scene/visitors/known_names.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// What something in a list of the scene is called, to be chosen where it is named.
std::vector<std::string> names_in_world(const PanelContext& context, std::string_view list) {
  std::vector<std::string> out;
  const Frame& frame = *context.model.frame;
  const auto take = [&](const std::string& name) {
    if (!name.empty()) out.push_back(name);
  };
  if (list == "bodies")
    for (size_t slot = 0; slot < frame.body_slots(); ++slot)
      if (!frame.body(slot).id.is_null()) take(frame.info(slot).name);
  if (list == "joints")
    for (const JointFrame& joint : *frame.joints) take(joint.name);
  const SceneDescription* parts = context.model.parts.get();
  if (parts && list == "particles")
    for (const auto& item : parts->particles.items) take(item.name);
  if (parts && list == "emitters")
    for (const auto& item : parts->emitters.items) take(item.name);
  return out;
}

/// Widgets for descriptions of parts, including nested objects, choices of kinds, and lists.
class PartWidgets : public ParameterWidgets {
 public:
  using ParameterWidgets::ParameterWidgets;

  template <class T>
  void field(T& value, const Parameter& p) {
    if constexpr (requires { ParameterWidgets::field(value, p); })
      ParameterWidgets::field(value, p);
  }
  void field(std::string& value, const Parameter& p) {
    if (!known_names(p.name).empty()) return ParameterWidgets::field(value, p);
    begin(p);
    const std::vector<std::string> names = names_in_world(context_, list_named_by(p.name));
    const float arrow = names.empty() ? 0 : ImGui::GetFrameHeight();
    auto said = typed_text(context_, mark_name(p), value, ImGui::CalcItemWidth() - arrow);
    tooltip_with_key(context_, p.doc, {});
    if (!names.empty())
      if (auto chosen = name_list(context_, mark_name(p), names)) said = std::move(chosen);
    if (!said) return;
    value = *std::move(said);
    note_change(p);
  }
  void field(uint64_t& value, const Parameter& p) {
    auto v = int(std::min<uint64_t>(value, 1'000'000));
    const bool before = changed;
    changed = false;
    ParameterWidgets::field(v, p);
    if (changed) value = uint64_t(std::max(v, 0));
    changed |= before;
  }
  template <class T>
  void field(std::optional<T>& value, const Parameter& p) {
    if (!given(value, p)) return;
    if constexpr (std::is_arithmetic_v<T>)
      if (fresh_) *value = std::clamp(T(1), least<T>(p), T(std::min(p.max, 1e6)));
    field(*value, p);
  }
  template <class T>
  void field(std::vector<T>& values, const Parameter& p) {
    for (size_t i = 0; i < values.size(); ++i) {
      Parameter one = p;
      const std::string name = fmt::format("{}.{}", p.name, i);
      one.name = name;
      field(values[i], one);
    }
    more_or_less(values, p);
  }
  /// Files can give orientations in several ways; here they are edited as angles.
  void part(Placement& value) {
    const Vec3 before = value.position;
    Vec3 position = before, angles = quat_to_euler_deg(value.pose().q);
    field(position, {.name = "position", .unit = "m", .min = -1e7, .max = 1e7, .doc = "origin"});
    value.position = position;
    const bool earlier = changed;
    changed = false;
    field(angles, {.name = "euler_deg",
                   .unit = "deg",
                   .min = -1e6,
                   .max = 1e6,
                   .doc = "turns about x, then the new y, then the new z"});
    if (changed) {
      value = {};
      value.position = position;
      value.euler_deg = angles;
    }
    changed |= earlier;
  }
  template <class T>
  void part(T& value) {
    T::parameters(*this, value);
  }
  template <class T>
  void object(T& value, const Parameter& p) {
    heading(p);
    inner(p, [&] { T::parameters(*this, value); });
  }
  template <class T>
  void object(std::optional<T>& value, const Parameter& p) {
    if (!given(value, p)) return;
    if constexpr (std::is_same_v<T, RandomNumberDescription>)
      if (fresh_) value->number.mean = 1;
    inner(p, [&] { T::parameters(*this, *value); });
  }
  template <class T>
  void list(std::vector<T>& values, const Parameter& p) {
    for (size_t i = 0; i < values.size(); ++i) {
      const std::string name =
          values.size() > 1 ? fmt::format("{} {}", p.name, i) : std::string(p.name);
      heading({.name = name});
      const std::string place = fmt::format("{}.{}", p.name, i);
      inner({.name = place}, [&] { T::parameters(*this, values[i]); });
    }
    more_or_less(values, p);
  }
  template <class... Ts>
  void one_of(std::variant<Ts...>& value, const Parameter& p) {
    const std::vector<std::string_view> names = {type_name_of<Ts>()...};
    size_t index = value.index();
    if (choice(index, names, p)) {
      size_t k = 0;
      ((k++ == index ? void(value = Ts{}) : void()), ...);
    }
    std::visit([this]<class T>(T& kind) { T::parameters(*this, kind); }, value);
  }
  template <class T>
  void map(NamedList<T>&, const Parameter&) {}

 private:
  template <class T>
  static T least(const Parameter& p) {
    return T(std::isfinite(p.min) ? p.min : 0);
  }
  template <class F>
  void inner(const Parameter& p, const F& draw) {
    const std::string outer = prefix_;
    prefix_ = mark_name(p);
    draw();
    prefix_ = outer;
  }
  /// A switch that sets or unsets an optional value; true if there is a value to show.
  template <class T>
  bool given(std::optional<T>& value, const Parameter& p) {
    bool on = value.has_value();
    fresh_ = false;
    if (toggle(context_, mark_name(p) + ".given", label_of(p.name).c_str(), on)) {
      fresh_ = on;
      on ? void(value.emplace()) : value.reset();
      note_change(p);
    }
    tooltip_with_key(context_, p.doc, {});
    return on;
  }
  template <class T>
  void more_or_less(std::vector<T>& values, const Parameter& p) {
    ImGui::PushID(mark_name(p).c_str());
    if (ImGui::SmallButton("+")) {
      values.push_back(values.empty() ? first<T>() : values.back());
      note_change(p);
    }
    context_.host.mark(mark_name(p) + ".more");
    ImGui::SameLine();
    if (!values.empty() && ImGui::SmallButton("-")) {
      values.pop_back();
      note_change(p);
    }
    context_.host.mark(mark_name(p) + ".less");
    ImGui::SameLine();
    ImGui::PopID();
    small_text(context_, label_of(p.name), palette::dim);
    tooltip_with_key(context_, p.doc, {});
  }
  template <class T>
  static T first() {
    if constexpr (std::is_arithmetic_v<T>)
      return T(1);
    else
      return T{};
  }

  bool fresh_ = false;  ///< the value drawn was set in this frame
};

}  // namespace

void draw_part_form(PanelContext& context, const std::string& name, const PartDescription& part) {
  PartDescription now = part;
  PartWidgets widgets(context, "part");
  ImGui::PushID(name.c_str());
  std::visit([&](auto& d) { widgets.part(d); }, now);
  ImGui::PopID();
  if (widgets.changed)
    context.ask(EditPart{name, part, now, fmt::format("Change {} of {}", widgets.edited, name)});
}

}  // namespace tumble
