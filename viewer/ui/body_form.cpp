#include "viewer/ui/body_form.hpp"

#include "engine/scene/build/describe_body.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/ui/mesh_form.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tumble {
namespace {

/// A part of the values of a body, under a heading of its own.
enum class Group : uint8_t { motion, body, look };

Group group_of(std::string_view name) {
  for (const std::string_view motion : {"position", "euler_deg", "velocity", "angular_velocity"})
    if (name == motion) return Group::motion;
  return name == "colour" ? Group::look : Group::body;
}

/// Whether the scene's file describes this body together with others (repetition).
bool is_copy(const BodyDef& def) {
  return def.name.ends_with(']');
}

/// Whether the file can only have one value of this for all copies.
bool is_of_all_copies(std::string_view name) {
  constexpr std::string_view common[] = {"group", "can_sleep", "precise", "hull_mass", "inertia"};
  return std::ranges::find(common, name) != std::end(common);
}

void say_it_is_of_all_copies(PanelContext& context, const BodyDef& def) {
  const std::string base = def.name.substr(0, def.name.find('['));
  small_text(context, fmt::format("What is grey is common to all copies of {}", base),
             palette::faint);
}

/// Widgets for the values of one group. Shapes have their own widgets; values that only occur in
/// files are left out.
class BodyWidgets : public ParameterWidgets {
 public:
  /// `group`: the values of this one; none: all.
  BodyWidgets(PanelContext& context, std::string prefix, std::optional<Group> group, BodyId body,
              const BodyDef& def)
      : ParameterWidgets(context, std::move(prefix)), group_(group), copy_(is_copy(def)) {
    if (!def.name.empty()) let_pin({def.name, {}, {}});
    const auto slot = find_slot(*context.model.frame, body);
    const Aabb bounds = slot ? body_bounds(*context.model.frame, *slot) : Aabb{};
    if (!bounds.empty()) set_size(bounds.extent().norm());
  }
  bool any_common = false;  ///< some of the values shown are common to all copies

  template <class T>
  void field(T& value, const Parameter& p) {
    const bool of_file = p.name == "present" || p.name == "starts_asleep" || p.name == "label" ||
                         p.name == "volumes" || p.name == "volumes_level";
    const Group group = in_look_ ? Group::look : group_of(p.name);
    if constexpr (requires { ParameterWidgets::field(value, p); })
      if (!of_file && (!group_ || group == *group_)) {
        const bool common = copy_ && (in_look_ || is_of_all_copies(p.name));
        any_common = any_common || common;
        ImGui::BeginDisabled(common);
        ParameterWidgets::field(value, p);
        ImGui::EndDisabled();
      }
  }
  // The editable form of an orientation is angles.
  void field(std::optional<Quat>&, const Parameter&) {}
  template <class T>
  void part(T& value) {
    T::parameters(*this, value);
  }
  void object(LookDescription& value, const Parameter&) {
    in_look_ = true;
    LookDescription::parameters(*this, value);
    in_look_ = false;
  }
  template <class T>
  void object(std::optional<T>&, const Parameter&) {}
  template <class T>
  void list(std::vector<T>&, const Parameter&) {}
  template <class T>
  void map(NamedList<T>&, const Parameter&) {}

 private:
  std::optional<Group> group_;
  bool copy_;
  bool in_look_ = false;
};

/// Widgets for a material, without its name, which has no effect on a body that exists.
class MaterialWidgets : public ParameterWidgets {
 public:
  using ParameterWidgets::field;
  using ParameterWidgets::ParameterWidgets;
  void field(std::string&, const Parameter&) {}
};

/// The definition with the body's present pose and velocities.
BodyDef at_this_moment(const BodyDef& def, const BodyFrame& body, const BodyInfo& info) {
  BodyDef now = def;
  now.pose = {body.pose.x - body.pose.direction(info.centre_body), body.pose.q};
  now.velocity = body.v;
  now.angular_velocity = body.omega;
  return now;
}

std::string undo_step(BodyId id, const BodyDef& def, const std::string& value) {
  const std::string name = def.name.empty() ? fmt::format("body {}", id.index) : def.name;
  return fmt::format("Change {} of {}", value, name);
}

BodyDescription shown_description(const BodyFrame& body, const BodyInfo& info, const BodyDef& def) {
  BodyDescription now = describe_body(at_this_moment(def, body, info));
  if (info.type == BodyType::dynamic) now.mass = info.mass;
  return now;
}

/// Draws the widgets, and asks for what was changed.
void edit_body_values(PanelContext& context, BodyId id, const BodyDef& def,
                      const BodyDescription& before, BodyWidgets& widgets) {
  BodyDescription now = before;
  BodyDescription::parameters(widgets, now);
  if (widgets.changed)
    context.ask(EditBody{id, undo_step(id, def, widgets.edited),
                         [before, now](BodyDef& d) { apply_changes(before, now, d); }});
}

void draw_body_values(PanelContext& context, const BodyFrame& body, const BodyInfo& info,
                      const BodyDef& def) {
  const BodyDescription before = shown_description(body, info, def);
  const std::pair<const char*, Group> groups[] = {
      {"Place and motion", Group::motion}, {"Body", Group::body}, {"Look", Group::look}};
  for (const auto& [title, group] : groups) {
    const bool open = ImGui::CollapsingHeader(title);
    context.host.mark(fmt::format("inspector.group.{}", int(group)));
    if (!open) continue;
    BodyWidgets widgets(context, "inspector", group, body.id, def);
    edit_body_values(context, body.id, def, before, widgets);
    if (widgets.any_common) say_it_is_of_all_copies(context, def);
  }
}

/// True when one of the numbers of the shape was changed.
bool shape_numbers(ParameterWidgets& widgets, ShapeDef& shape) {
  for (const ShapeParameter& p : shape_entry(shape.type).parameters) {
    if (p.number) {
      double shown = shape.*p.number / p.factor;
      widgets.field(shown, p.parameter);
      if (widgets.changed) shape.*p.number = shown * p.factor;
    } else if (p.vector) {
      Vec3 shown = shape.*p.vector / p.factor;
      widgets.field(shown, p.parameter);
      if (widgets.changed) shape.*p.vector = shown * p.factor;
    }
    if (!widgets.changed) continue;
    shape.field = nullptr;  // a distance field computed for the former numbers
    return true;
  }
  return false;
}

/// The pose of a shape in its body, as scene files give it. True if it was changed.
bool shape_place(ParameterWidgets& widgets, Pose& pose) {
  Placement place;
  place.position = pose.x;
  Vec3 angles = quat_to_euler_deg(pose.q);
  widgets.field(place.position, {.name = "position",
                                 .unit = "m",
                                 .min = -1e7,
                                 .max = 1e7,
                                 .doc = "of the shape, in the body's frame"});
  const bool moved = widgets.changed;
  widgets.field(angles, {.name = "euler_deg",
                         .unit = "deg",
                         .min = -1e6,
                         .max = 1e6,
                         .doc = "turns about x, then the new y, then the new z"});
  if (!widgets.changed) return false;
  pose.x = place.position;
  if (!moved) pose.q = euler_deg_to_quat(angles);
  return true;
}

bool is_of_mesh(const BodyShapeDef& part) {
  return part.source || made_of_mesh(part.shape.type);
}

/// A button that removes the shape; true if it was pressed.
bool draw_removal(PanelContext& context, const BodyDef& def, size_t index) {
  if (def.shapes.size() < 2 || is_of_mesh(def.shapes[index])) return false;
  ImGui::PushID(int(index));
  const bool remove = ImGui::Button("Remove this shape");
  ImGui::PopID();
  context.host.mark(fmt::format("inspector.shape.{}.remove", index));
  if (remove)
    context.ask(EditBody{context.model.selected, undo_step(context.model.selected, def, "shapes"),
                         [index](BodyDef& d) {
                           if (index < d.shapes.size() && d.shapes.size() > 1)
                             d.shapes.erase(d.shapes.begin() + std::ptrdiff_t(index));
                         }});
  return remove;
}

/// A new shape with the material of the first one, placed on top of the others.
BodyShapeDef fresh_shape(const BodyDef& def, ShapeType type) {
  BodyShapeDef out;
  out.shape.type = type;
  double top = 0;
  for (const BodyShapeDef& part : def.shapes)
    if (const auto made = make_shape(part.shape))
      if (const double y = (*made)->bounds(part.pose).max.y(); std::isfinite(y)) top = y;
  if (!def.shapes.empty()) out.material = def.shapes[0].material;
  // Half a metre; the size can be changed in the fields below.
  constexpr double size = 0.5;
  out.shape.radius *= size;
  out.shape.top_radius *= size;
  out.shape.height *= size;
  out.shape.half_extents *= size;
  if (const auto made = make_shape(out.shape))
    if (const double below = (*made)->bounds({}).min.y(); std::isfinite(below))
      out.pose.x = Vec3(0, top - below, 0);
  return out;
}

void draw_shape_choice(PanelContext& context, const BodyDef& def) {
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##add shape", "add a shape ...")) {
    for (const ShapeEntry& entry : all_shapes()) {
      if (made_of_mesh(entry.type)) continue;
      const auto made = make_shape(fresh_shape(def, entry.type).shape);
      if (!made || !std::isfinite((*made)->bounding_radius())) continue;
      const std::string name(entry.name);
      if (ImGui::Selectable(label_of(name).c_str()))
        context.ask(EditBody{
            context.model.selected, undo_step(context.model.selected, def, "shapes"),
            [type = entry.type](BodyDef& d) { d.shapes.push_back(fresh_shape(d, type)); }});
      context.host.mark("inspector.add_shape." + name);
    }
    ImGui::EndCombo();
  }
  context.host.mark("inspector.add_shape");
}

/// The body's name. Changing it also changes every reference in the scene.
void draw_name(PanelContext& context, const BodyDef& def) {
  if (is_copy(def) || def.name.empty()) return;
  ImGui::AlignTextToFramePadding();
  small_text(context, "name", palette::dim);
  ImGui::SameLine(64);
  ImGui::SetNextItemWidth(-1);
  std::string name = def.name;
  if (ImGui::InputText("##name", &name, ImGuiInputTextFlags_EnterReturnsTrue) && name != def.name)
    context.ask(EditBody{context.model.selected, "Rename " + def.name,
                         [name](BodyDef& d) { d.name = name; }});
  context.host.mark("inspector.name");
  tooltip_with_key(context, "what the scene calls it, wherever it is named", {});
}

/// Where the values of a shape and its material are, which are called "shape.0.radius".
PinOwner place_of_shape(const BodyDef& def, size_t index) {
  return {def.name, {}, fmt::format("shape.{}.", index)};
}

/// Draws the widgets of a shape and its material, and asks for what was changed.
void edit_shape_values(PanelContext& context, BodyId id, const BodyDef& def, size_t index,
                       MaterialWidgets& widgets) {
  BodyShapeDef part = def.shapes[index];
  const auto ask = [&](std::function<void(BodyDef&)> change) {
    context.ask(EditBody{id, undo_step(id, def, widgets.edited), std::move(change)});
  };
  ImGui::BeginDisabled(is_copy(def));
  bool shape_changed = shape_numbers(widgets, part.shape);
  if (!shape_changed && !is_of_mesh(part)) shape_changed = shape_place(widgets, part.pose);
  ImGui::EndDisabled();
  if (shape_changed) {
    // If the mass was not given but computed from the shapes, it is computed again.
    ask([index, shape = part.shape, pose = part.pose](BodyDef& d) {
      if (index >= d.shapes.size()) return;
      d.shapes[index].shape = shape;
      d.shapes[index].pose = pose;
    });
    return;
  }
  MaterialDescription now = describe_material(part.material);
  // Given explicitly, so that it is shown and can be changed even if the material has no such
  // value.
  now.rolling_friction = part.material.rolling_arm();
  now.torsional_friction = part.material.torsional_arm();
  const MaterialDescription before = now;
  MaterialDescription::parameters(widgets, now);
  if (!widgets.changed) return;
  ask([index, before, now](BodyDef& d) {
    if (index >= d.shapes.size()) return;
    apply_changes(before, now, d.shapes[index].material);
    if (before.density != now.density) d.mass.reset();
  });
}

void draw_shape_values(PanelContext& context, const BodyDef& def, size_t index) {
  if (!is_copy(def) && draw_removal(context, def, index)) return;
  if (is_copy(def)) say_it_is_of_all_copies(context, def);
  MaterialWidgets widgets(context, fmt::format("inspector.shape.{}", index));
  if (!def.name.empty()) widgets.let_pin(place_of_shape(def, index));
  edit_shape_values(context, context.model.selected, def, index, widgets);
}

}  // namespace

void draw_body_form(PanelContext& context, const BodyFrame& body, const BodyDef& def) {
  const auto slot = find_slot(*context.model.frame, body.id);
  if (!slot) return;
  draw_name(context, def);
  draw_mesh_form(context, def);
  draw_body_values(context, body, context.model.frame->info(*slot), def);
  constexpr size_t most = 8;
  for (size_t i = 0; i < std::min(def.shapes.size(), most); ++i) {
    std::string title = label_of(shape_entry(def.shapes[i].shape.type).name);
    title = fmt::format("Shape and material: {}##shape{}", title, i);
    const bool open = ImGui::CollapsingHeader(title.c_str());
    context.host.mark(fmt::format("inspector.shape.{}", i));
    if (open) draw_shape_values(context, def, i);
  }
  if (!is_copy(def)) draw_shape_choice(context, def);
  if (def.shapes.size() > most)
    small_text(context, fmt::format("and {} more shapes", def.shapes.size() - most),
               palette::faint);
}

bool draw_pinned_body_value(PanelContext& context, const Pin& pin, const std::string& mark,
                            const BodyFrame& body, const BodyDef& def) {
  const auto slot = find_slot(*context.model.frame, body.id);
  if (!slot) return false;
  for (size_t i = 0; i < def.shapes.size(); ++i) {
    const PinOwner place = place_of_shape(def, i);
    if (!pin.value.starts_with(place.prefix)) continue;
    MaterialWidgets widgets(context, mark + "." + place.prefix.substr(0, place.prefix.size() - 1));
    widgets.let_pin(place);
    widgets.draw_only(pin);
    edit_shape_values(context, body.id, def, i, widgets);
    return widgets.drawn;
  }
  BodyWidgets widgets(context, mark, std::nullopt, body.id, def);
  widgets.draw_only(pin);
  edit_body_values(context, body.id, def,
                   shown_description(body, context.model.frame->info(*slot), def), widgets);
  return widgets.drawn;
}

}  // namespace tumble
