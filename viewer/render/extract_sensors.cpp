#include "viewer/render/extract.hpp"
#include "viewer/render/overlay_colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr int sides_of_circle = 48;

/// Lines of a sensor's form.
struct Outline {
  const Pose& frame;
  Vec4f colour;
  RenderScene& out;

  void line(const Vec3& a, const Vec3& b) const {
    out.lines.push_back({.a = frame.point(a).cast<float>(),
                         .b = frame.point(b).cast<float>(),
                         .colour = colour,
                         .width = 1.5f});
  }
  /// An ellipse about the origin of u and v, moved by `middle`.
  void circle(const Vec3& middle, const Vec3& u, const Vec3& v) const {
    Vec3 last = middle + u;
    for (int k = 1; k <= sides_of_circle; ++k) {
      const double angle = 2 * M_PI * k / sides_of_circle;
      const Vec3 next = middle + std::cos(angle) * u + std::sin(angle) * v;
      line(last, next);
      last = next;
    }
  }
  void rectangle(const Vec3& middle, const Vec3& u, const Vec3& v) const {
    const std::array<Vec3, 4> corners = {middle - u - v, middle + u - v, middle + u + v,
                                         middle - u + v};
    for (size_t k = 0; k < 4; ++k) line(corners[k], corners[(k + 1) % 4]);
  }
  /// Marks the direction that counts as forward.
  void arrow(double size) const {
    const Vec3 tip(0, size, 0);
    line(Vec3::Zero(), tip);
    for (const double side : {-0.2, 0.2}) line(tip, {side * size, 0.75 * size, 0});
  }
  void draw(const SensorShape& shape) const {
    const Vec3 x(shape.half.x(), 0, 0), y(0, shape.half.y(), 0), z(0, 0, shape.half.z());
    const Vec3 round(0, 0, shape.half.x()), up(0, shape.half.x(), 0);
    switch (shape.form) {
      case SensorForm::disc:
        circle(Vec3::Zero(), x, round);
        return arrow(0.5 * x.norm());
      case SensorForm::rectangle:
        rectangle(Vec3::Zero(), x, z);
        return arrow(0.5 * std::min(x.norm(), z.norm()));
      case SensorForm::box:
        rectangle(-y, x, z);
        rectangle(y, x, z);
        for (const double a : {-1.0, 1.0})
          for (const double b : {-1.0, 1.0}) line(a * x + b * z - y, a * x + b * z + y);
        return;
      case SensorForm::sphere:
        circle(Vec3::Zero(), x, round);
        circle(Vec3::Zero(), x, up);
        return circle(Vec3::Zero(), up, round);
      case SensorForm::cylinder:
        circle(-y, x, round);
        circle(y, x, round);
        for (const double a : {-1.0, 1.0}) {
          line(a * x - y, a * x + y);
          line(a * round - y, a * round + y);
        }
        return;
    }
  }
};

std::string label_of(const SensorFrame& s) {
  switch (s.kind) {
    case SensorKind::gate:
      // In a row of many there is only room for the net count.
      if (s.name.ends_with(']')) return fmt::format("{}", int64_t(s.forward) - int64_t(s.backward));
      return s.flow == 0
                 ? fmt::format("{}: {}", s.name, s.forward + s.backward)
                 : fmt::format("{}: {}, {:.3g} kg/s", s.name, s.forward + s.backward, s.flow);
    case SensorKind::region:
      return fmt::format("{}: {}, {:.3g} kg", s.name, s.inside.size() + s.particles, s.mass);
    case SensorKind::radial:  // has no place in space
    case SensorKind::contact:
      break;
  }
  return s.touching ? fmt::format("{}: {:.3g} N", s.name, s.force.norm()) : s.name + ": apart";
}

void add_label(const SensorFrame& sensor, const Vec3& x, const Vec4f& colour, RenderScene& out) {
  TextLabel label;
  label.text = label_of(sensor);
  label.x = x.cast<float>();
  label.colour = colour;
  label.anchor = Vec3f(0.5f, 0.5f, 0);
  label.plate = 0.6f;
  out.texts.push_back(std::move(label));
}

/// Whether something is inside it, passes through, or touches it.
bool answers(const SensorFrame& s) {
  return s.touching || s.flow != 0 || !s.inside.empty() || s.particles > 0;
}

bool is_there(const Frame& frame, BodyId id) {
  return !id.is_null() && id.index < frame.body_slots() && frame.body(id.index).id == id;
}

}  // namespace

void add_sensors(const Frame& frame, const std::vector<Pose>& poses, RenderScene& out) {
  if (!frame.sensors) return;
  for (const SensorFrame& s : *frame.sensors) {
    if (s.gone || s.kind == SensorKind::radial) continue;
    const Vec4f& colour = answers(s) ? overlay_colour::sensing : overlay_colour::sensor;
    if (s.kind == SensorKind::contact) {
      if (is_there(frame, s.a)) add_label(s, poses[s.a.index].x, colour, out);
      continue;
    }
    Pose pose = s.pose;  // at the end of the tick
    if (is_there(frame, s.carrier))
      pose = poses[s.carrier.index] * (frame.body(s.carrier.index).pose.inverse() * s.pose);
    Outline{pose, colour, out}.draw(s.shape);
    add_label(s, pose.x, colour, out);
  }
}

}  // namespace tumble
