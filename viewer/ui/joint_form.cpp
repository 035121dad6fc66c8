#include "viewer/ui/joint_form.hpp"

#include "engine/scene/description/joint.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Rate with which a new motor, or the natural frequency with which a new spring, moves the bodies
/// [1/s].
constexpr double new_rate = 1;

/// One coordinate of a joint and the units in which it is shown.
struct Shown {
  PanelContext& context;
  const SelectedJoint& joint;
  size_t k;
  const JointCoordinate& coordinate;
  std::string prefix;
  std::string body;           ///< through which it is shown
  const Pin* only = nullptr;  ///< null: all values are drawn
  bool* drawn = nullptr;      ///< set where one is drawn

  double unit() const { return coordinate.angle ? degree : 1; }
  std::string_view value_unit() const { return coordinate.angle ? "deg" : "m"; }
  std::string_view force_unit() const { return coordinate.angle ? "N m" : "N"; }
  std::string_view stiffness_unit() const { return coordinate.angle ? "N m/rad" : "N/m"; }
  std::string_view damping_unit() const { return coordinate.angle ? "N m s/rad" : "N s/m"; }
  std::string_view rate_unit() const { return coordinate.angle ? "rad/s" : "m/s"; }

  void ask(const std::string& what, std::function<void(CoordinateDrive&)> change) const {
    context.ask(EditJoint{
        joint.id,
        fmt::format("Change {} of {}", what, joint.def.name.empty() ? "a joint" : joint.def.name),
        [change = std::move(change), at = k](JointDef& d) { change(d.drives[at]); }});
  }
};

/// A field for a number of the drive, in units of `unit`.
void number(const Shown& s, double shown_now, const Parameter& p, double unit,
            const std::function<void(CoordinateDrive&, double)>& set) {
  ParameterWidgets widgets(s.context, s.prefix);
  if (!s.body.empty() && !s.joint.def.name.empty())
    widgets.let_pin({s.body, s.joint.def.name, std::string(s.coordinate.name) + "."});
  if (s.only) widgets.draw_only(*s.only);
  double value = shown_now;
  widgets.field(value, p);
  if (widgets.drawn && s.drawn) *s.drawn = true;
  if (widgets.changed)
    s.ask(widgets.edited, [set, value, unit](CoordinateDrive& d) { set(d, unit * value); });
}

/// A switch for an optional part of the joint's drive.
bool part(const Shown& s, const char* name, bool on,
          const std::function<void(CoordinateDrive&, bool)>& set) {
  if (s.only) return on;
  bool wanted = on;
  if (toggle(s.context, fmt::format("{}.{}", s.prefix, name), name, wanted))
    s.ask(name, [set, wanted](CoordinateDrive& d) { set(d, wanted); });
  return on;
}

void draw_limits(const Shown& s, const CoordinateLimits& limits, double value_now) {
  const bool on = part(s, "limits", limits.exist(),
                       [value_now, angle = s.coordinate.angle](CoordinateDrive& d, bool wanted) {
                         d.limits = {};
                         const double half = angle ? std::numbers::pi / 4 : 0.5;
                         if (wanted)
                           d.limits.lower = value_now - half, d.limits.upper = value_now + half;
                       });
  if (!on) return;
  const double u = s.unit();
  const Parameter lower{.name = "lower", .unit = s.value_unit(), .doc = "where it stops"};
  const Parameter upper{.name = "upper", .unit = s.value_unit(), .doc = "where it stops"};
  if (limits.lower > -no_bound)
    number(s, limits.lower / u, lower, u,
           [](CoordinateDrive& d, double v) { d.limits.lower = std::min(v, d.limits.upper); });
  if (limits.upper < no_bound)
    number(s, limits.upper / u, upper, u,
           [](CoordinateDrive& d, double v) { d.limits.upper = std::max(v, d.limits.lower); });
  number(s, limits.stiffness,
         {.name = "stop_stiffness",
          .unit = s.stiffness_unit(),
          .min = 0,
          .max = 1e12,
          .doc = "of a stop that gives way; 0: a hard one"},
         1, [](CoordinateDrive& d, double v) {
           d.limits.stiffness = v;
           if (v > 0) d.limits.restitution = 0;
           if (v == 0) d.limits.damping = 0;
         });
  if (limits.hard())
    number(s, limits.restitution,
           {.name = "restitution", .min = 0, .max = 1, .doc = "speed after the stop over before"},
           1, [](CoordinateDrive& d, double v) { d.limits.restitution = v; });
  else
    number(s, limits.damping,
           {.name = "stop_damping", .unit = s.damping_unit(), .min = 0, .max = 1e12}, 1,
           [](CoordinateDrive& d, double v) { d.limits.damping = v; });
}

CoordinateMotor new_motor(MotorKind kind, double value_now) {
  CoordinateMotor motor;
  motor.kind = kind;
  if (kind == MotorKind::velocity) motor.target = new_rate;
  if (kind == MotorKind::position) {
    motor.target = value_now;
    motor.stiffness = 100;
    motor.damping = 10;
  }
  return motor;
}

void draw_motor(const Shown& s, const CoordinateMotor& motor, double value_now) {
  constexpr std::array<std::string_view, 4> kinds = {"none", "velocity", "position", "force"};
  ParameterWidgets widgets(s.context, s.prefix);
  size_t kind = size_t(motor.kind);
  if (!s.only &&
      widgets.choice(kind, kinds, {.name = "motor", .doc = "what drives this coordinate"}))
    s.ask("motor",
          [made = new_motor(MotorKind(kind), value_now)](CoordinateDrive& d) { d.motor = made; });
  if (motor.kind == MotorKind::none) return;
  const bool position = motor.kind == MotorKind::position;
  const double u = position ? s.unit() : 1;
  const std::string_view unit = position                            ? s.value_unit()
                                : motor.kind == MotorKind::velocity ? s.rate_unit()
                                                                    : s.force_unit();
  if (motor.course && s.only) return;
  if (motor.course)
    note("Its target changes over time, as the scene's file says.");
  else
    number(s, motor.target / u, {.name = "target", .unit = unit, .min = -1e9, .max = 1e9}, u,
           [](CoordinateDrive& d, double v) { d.motor.target = v; });
  if (position) {
    number(s, motor.stiffness,
           {.name = "motor_stiffness",
            .unit = s.stiffness_unit(),
            .min = 0,
            .max = 1e12,
            .exclusive_min = true},
           1, [](CoordinateDrive& d, double v) { d.motor.stiffness = v; });
    number(s, motor.damping,
           {.name = "motor_damping", .unit = s.damping_unit(), .min = 0, .max = 1e12}, 1,
           [](CoordinateDrive& d, double v) { d.motor.damping = v; });
  }
  if (motor.kind == MotorKind::force) return;
  const bool capped = part(s, "cap", motor.max_force < no_bound, [](CoordinateDrive& d, bool on) {
    d.motor.max_force = on ? 100 : no_bound;
  });
  if (capped)
    number(s, motor.max_force,
           {.name = "max_force", .unit = s.force_unit(), .min = 0, .max = 1e15, .doc = "at most"},
           1, [](CoordinateDrive& d, double v) { d.motor.max_force = v; });
}

void draw_spring(const Shown& s, const CoordinateSpring& spring, double value_now) {
  const bool there = spring.stiffness > 0 || spring.damping > 0;
  const bool on = part(s, "spring", there, [value_now](CoordinateDrive& d, bool wanted) {
    d.spring = {};
    if (wanted) d.spring = {100, 1, value_now};
  });
  if (!on) return;
  number(s, spring.stiffness,
         {.name = "spring_stiffness", .unit = s.stiffness_unit(), .min = 0, .max = 1e12}, 1,
         [](CoordinateDrive& d, double v) { d.spring.stiffness = v; });
  number(s, spring.damping,
         {.name = "spring_damping", .unit = s.damping_unit(), .min = 0, .max = 1e12}, 1,
         [](CoordinateDrive& d, double v) { d.spring.damping = v; });
  number(s, spring.rest / s.unit(),
         {.name = "rest", .unit = s.value_unit(), .min = -1e7, .max = 1e7}, s.unit(),
         [](CoordinateDrive& d, double v) { d.spring.rest = v; });
}

void draw_coordinate(const Shown& s, const CoordinateFrame& now) {
  const CoordinateDrive& drive = s.joint.def.drives[s.k];
  if (!s.only)
    value_row(s.coordinate.name, fmt::format("{:.4g} {}   {:.3g} {}", now.value / s.unit(),
                                             s.value_unit(), now.rate, s.rate_unit()));
  draw_limits(s, drive.limits, now.value);
  draw_motor(s, drive.motor, now.value);
  draw_spring(s, drive.spring, now.value);
  number(s, drive.friction,
         {.name = "friction", .unit = s.force_unit(), .min = 0, .max = 1e15, .doc = "dry friction"},
         1, [](CoordinateDrive& d, double v) { d.friction = v; });
  number(s, drive.armature,
         {.name = "armature",
          .unit = s.coordinate.angle ? "kg m2" : "kg",
          .min = 0,
          .max = 1e12,
          .doc = "inertia of a geared rotor"},
         1, [](CoordinateDrive& d, double v) { d.armature = v; });
  if (drive.couple && !s.only) note("It follows another coordinate, as by gears.");
}

/// The force and torque at which the joint breaks.
void draw_strength(PanelContext& context, const SelectedJoint& joint, size_t index) {
  /// Initial strength of a joint that is made breakable [N], [N m].
  constexpr double first_bound = 1000;
  const std::string prefix = fmt::format("joint.{}", index);
  for (const auto& [name, unit, member] :
       {std::tuple("break_force", "N", &JointDef::break_force),
        std::tuple("break_torque", "N m", &JointDef::break_torque)}) {
    const auto ask = [&, name = name, to = member](double bound) {
      context.ask(EditJoint{joint.id,
                            fmt::format("Change {} of {}", label_of(name), joint.def.name),
                            [to, bound](JointDef& d) { d.*to = bound; }});
    };
    bool breaks = joint.def.*member < no_bound;
    if (toggle(context, fmt::format("{}.{}.given", prefix, name), label_of(name).c_str(), breaks))
      ask(breaks ? first_bound : no_bound);
    if (!breaks) continue;
    ParameterWidgets widgets(context, prefix);
    double bound = joint.def.*member;
    widgets.field(bound, {.name = name,
                          .unit = unit,
                          .min = 0,
                          .max = 1e15,
                          .exclusive_min = true,
                          .doc = "it breaks where more than this would be needed to hold it"});
    if (widgets.changed) ask(bound);
  }
}

const JointFrame* frame_of(const Frame& frame, JointId id) {
  for (const JointFrame& joint : *frame.joints)
    if (joint.id == id) return &joint;
  return nullptr;
}

void draw_joint(PanelContext& context, const SelectedJoint& joint, const JointFrame& now,
                size_t index) {
  const JointKindEntry& kind = entry_of(joint.def.kind);
  const auto slot = find_slot(*context.model.frame, joint.other);
  const std::string other = slot ? context.model.frame->info(*slot).name : "the world";
  const std::string title =
      fmt::format("{} ({} to {})###joint{}", joint.def.name, kind.name, other, index);
  const bool open = ImGui::CollapsingHeader(title.c_str());
  context.host.mark(fmt::format("joint.{}", index));
  if (!open) return;
  for (size_t k = 0; k < kind.coordinates.size(); ++k) {
    const Shown shown{context,
                      joint,
                      k,
                      kind.coordinates[k],
                      fmt::format("joint.{}.{}", index, kind.coordinates[k].name),
                      context.model.selected_def ? context.model.selected_def->name : ""};
    ImGui::PushID(int(k));
    draw_coordinate(shown, now.coordinates[k]);
    ImGui::PopID();
  }
  draw_strength(context, joint, index);
  value_row("force", quantity_text(now.mean_force.norm(), "N"));
  value_row("torque", quantity_text(now.mean_torque.norm(), "N m"));
  if (ImGui::Button("Remove joint")) context.ask(RemoveJoint{joint.id});
  context.host.mark(fmt::format("joint.{}.remove", index));
  ImGui::SameLine();
  if (ImGui::Button("All values ...")) {
    context.state.described =
        ScenePath{} / "joints" / joint.def.name.substr(0, joint.def.name.find('['));
    context.state.shows(PanelId::description) = true;
  }
  context.host.mark(fmt::format("joint.{}.describe", index));
  tooltip_with_key(context, "every value of the file, and its name",
                   shortcut_of(Action::toggle_description));
}

}  // namespace

void draw_joint_form(PanelContext& context) {
  const auto& joints = context.model.selected_joints;
  if (!joints || joints->empty()) return;
  section(context, "Joints");
  for (size_t i = 0; i < joints->size(); ++i) {
    const JointFrame* now = frame_of(*context.model.frame, (*joints)[i].id);
    if (!now) continue;
    ImGui::PushID(int(i));
    draw_joint(context, (*joints)[i], *now, i);
    ImGui::PopID();
  }
}

bool draw_pinned_joint_value(PanelContext& context, const Pin& pin, const std::string& mark,
                             const SelectedJoint& joint) {
  const JointFrame* now = frame_of(*context.model.frame, joint.id);
  if (!now) return false;
  bool drawn = false;
  const JointKindEntry& kind = entry_of(joint.def.kind);
  for (size_t k = 0; k < kind.coordinates.size(); ++k) {
    const std::string name(kind.coordinates[k].name);
    if (pin.value.starts_with(name + "."))
      draw_coordinate(
          {context, joint, k, kind.coordinates[k], mark + "." + name, pin.body, &pin, &drawn},
          now->coordinates[k]);
  }
  return drawn;
}

}  // namespace tumble
