#include "viewer/ui/body_form.hpp"

#include "engine/scene/build/describe_body.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/ui/mesh_form.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"

#include <algorithm>
#include <functional>
#include <iterator>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// A part of the values of a body, under a heading of its own.
enum class Group : uint8_t { motion, body, look };

Group group_of(std::string_view name) {
  for (const std::string_view motion : {"position", "euler_deg", "velocity", "angular_velocity"})
    if (name == motion) return Group::motion;
  return name == "colour" ? Group::look : Group::body;
}

/// A body of which the scene's file describes several at once.
bool is_copy(const BodyDef& def) {
  return def.name.ends_with(']');
}

/// What the file says once for all copies: one alone cannot have another.
bool is_of_all_copies(std::string_view name) {
  constexpr std::string_view common[] = {"group", "can_sleep", "precise", "hull_mass", "inertia"};
  return std::ranges::find(common, name) != std::end(common);
}

void say_it_is_of_all_copies(PanelContext& context, const BodyDef& def) {
  const std::string base = def.name.substr(0, def.name.find('['));
  small_text(context, fmt::format("What is grey is common to all copies of {}", base),
             palette::faint);
}

/// The values of one group. Shapes have their own widgets; what only files know is left out.
class BodyWidgets : public ParameterWidgets {
 public:
  BodyWidgets(PanelContext& context, std::string prefix, Group group, bool copy)
      : ParameterWidgets(context, std::move(prefix)), group_(group), copy_(copy) {}
  bool any_common = false;  ///< some stand there that are common to all copies

  template <class T>
  void field(T& value, const Parameter& p) {
    const bool of_file = p.name == "present" || p.name == "starts_asleep" || p.name == "label" ||
                         p.name == "volumes" || p.name == "volumes_level";
    const Group group = in_look_ ? Group::look : group_of(p.name);
    if constexpr (requires { ParameterWidgets::field(value, p); })
      if (!of_file && group == group_) {
        const bool common = copy_ && (in_look_ || is_of_all_copies(p.name));
        any_common = any_common || common;
        ImGui::BeginDisabled(common);
        ParameterWidgets::field(value, p);
        ImGui::EndDisabled();
      }
  }
  void field(std::optional<Quat>&, const Parameter&) {}  // angles are what people read
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
  Group group_;
  bool copy_;
  bool in_look_ = false;
};

/// Of a material; its name is gone once it is made.
class MaterialWidgets : public ParameterWidgets {
 public:
  using ParameterWidgets::field;
  using ParameterWidgets::ParameterWidgets;
  void field(std::string&, const Parameter&) {}
};

/// The definition as it would be with the pose and velocities of this moment.
BodyDef at_this_moment(const BodyDef& def, const BodyFrame& body, const BodyInfo& info) {
  BodyDef now = def;
  now.pose = {body.pose.x - body.pose.direction(info.centre_body), body.pose.q};
  now.velocity = body.v;
  now.angular_velocity = body.omega;
  return now;
}

std::string deed(const PanelContext& context, const BodyDef& def, const std::string& value) {
  const std::string name =
      def.name.empty() ? fmt::format("body {}", context.model.selected.index) : def.name;
  return fmt::format("Change {} of {}", value, name);
}

void draw_body_values(PanelContext& context, const BodyFrame& body, const BodyInfo& info,
                      const BodyDef& def) {
  BodyDescription now = describe_body(at_this_moment(def, body, info));
  if (info.type == BodyType::dynamic) now.mass = info.mass;
  const BodyDescription before = now;
  const std::pair<const char*, Group> groups[] = {
      {"Place and motion", Group::motion}, {"Body", Group::body}, {"Look", Group::look}};
  for (const auto& [title, group] : groups) {
    const bool open = ImGui::CollapsingHeader(title);
    context.host.mark(fmt::format("inspector.group.{}", int(group)));
    if (!open) continue;
    BodyWidgets widgets(context, "inspector", group, is_copy(def));
    BodyDescription::parameters(widgets, now);
    if (widgets.any_common) say_it_is_of_all_copies(context, def);
    if (widgets.changed)
      context.ask(EditBody{body.id, deed(context, def, widgets.edited),
                           [before, now](BodyDef& d) { apply_changes(before, now, d); }});
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
    shape.field = nullptr;  // one that was made already had the number of before
    return true;
  }
  return false;
}

void draw_shape_values(PanelContext& context, const BodyDef& def, size_t index) {
  BodyShapeDef part = def.shapes[index];
  const std::string prefix = fmt::format("inspector.shape.{}", index);
  MaterialWidgets widgets(context, prefix);
  const auto ask = [&](std::function<void(BodyDef&)> change) {
    context.ask(
        EditBody{context.model.selected, deed(context, def, widgets.edited), std::move(change)});
  };
  ImGui::BeginDisabled(is_copy(def));
  const bool shape_changed = shape_numbers(widgets, part.shape);
  ImGui::EndDisabled();
  if (is_copy(def)) say_it_is_of_all_copies(context, def);
  if (shape_changed) {
    // A mass that was only ever the shapes' follows them.
    ask([index, shape = part.shape](BodyDef& d) {
      if (index < d.shapes.size()) d.shapes[index].shape = shape;
    });
    return;
  }
  MaterialDescription now = describe_material(part.material);
  // Shown, and so to be changed, also where the material does not give them.
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

}  // namespace

void draw_body_form(PanelContext& context, const BodyFrame& body, const BodyDef& def) {
  const auto slot = find_slot(*context.model.frame, body.id);
  if (!slot) return;
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
  if (def.shapes.size() > most)
    small_text(context, fmt::format("and {} more shapes", def.shapes.size() - most),
               palette::faint);
}

}  // namespace tumble
