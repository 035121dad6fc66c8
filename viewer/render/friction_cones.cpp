#include "viewer/render/friction_cones.hpp"

#include "engine/math/rotation.hpp"
#include "viewer/render/overlay_colours.hpp"
#include "viewer/render/scene_scales.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

struct GripColours {
  Vec4f cone, force;
};

GripColours colours_of(ContactGrip grip) {
  if (grip == ContactGrip::slide) return {overlay_colour::slides, {0.55f, 0.03f, 0.0f, 1}};
  return {overlay_colour::sticks, {0.02f, 0.3f, 0.1f, 1}};
}

void add_cone(const ContactFrame& c, double slant, Occlusion occlusion, RenderScene& out) {
  constexpr int sides = 16, edges = 4;
  const GripColours colours = colours_of(grip_of(c));
  const double opening = std::atan(c.friction);
  const double height = slant * std::cos(opening), radius = slant * std::sin(opening);
  const auto line = [&](const Vec3& a, const Vec3& b, const Vec4f& colour, float width) {
    out.lines.push_back({a.cast<float>(), b.cast<float>(), colour, width, occlusion});
  };
  if (c.friction > 0) {
    Vec3 u, v;
    tangent_frame(c.normal, u, v);
    const auto rim = [&](int i) {
      const double angle = 2 * M_PI * i / sides;
      return Vec3(c.x_world + height * c.normal +
                  radius * (std::cos(angle) * u + std::sin(angle) * v));
    };
    for (int i = 0; i < sides; ++i) line(rim(i), rim(i + 1), colours.cone, 1.5f);
    for (int i = 0; i < sides; i += sides / edges) line(c.x_world, rim(i), colours.cone, 1.5f);
  }
  // Scaled to the height of the rim. With an iterative solver the impulse may be outside the cone;
  // the line is then as long as the slant edge.
  const double scale = std::min(height / c.impulse.dot(c.normal), slant / c.impulse.norm());
  line(c.x_world, c.x_world + scale * c.impulse, colours.force, 3);
}

}  // namespace

ContactGrip grip_of(const ContactFrame& c) {
  const double pressing = c.impulse.dot(c.normal);
  if (!(pressing > 0)) return ContactGrip::none;
  const double sideways = (c.impulse - pressing * c.normal).norm();
  return sideways >= (1 - 1e-6) * c.friction * pressing ? ContactGrip::slide : ContactGrip::stick;
}

void add_friction_cones(const Frame& frame, BodyId selected, RenderScene& out) {
  const double slant = 0.75 * typical_size(frame);
  // Cones are inside the pressed body. Those of one body are drawn over everything; those of all
  // bodies would be too dense.
  const Occlusion occlusion = selected ? Occlusion::none : Occlusion::faint;
  frame.for_contacts([&](const ContactFrame& c) {
    const bool shown = !selected || c.a == selected || c.b == selected;
    if (shown && grip_of(c) != ContactGrip::none) add_cone(c, slant, occlusion, out);
  });
}

}  // namespace tumble
