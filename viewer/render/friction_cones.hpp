#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/render_scene.hpp"

namespace tumble {

/// What a contact did in the last tick, as its impulse tells.
enum class ContactGrip : uint8_t {
  none,   ///< no impulse: the bodies do not press on each other
  stick,  ///< inside the cone
  slide,  ///< on the cone to six digits: friction is as great as it can be
};
ContactGrip grip_of(const ContactFrame& contact);

/// Coulomb's cone at every contact point that presses, of the `selected` body alone when there is
/// one: the tip is the point, the axis the normal, the tangent of half the opening is the
/// coefficient of friction. The thick line within is the contact force: along the axis without
/// friction, on the cone where the contact slides. Slant edges have one length throughout a
/// picture. Colour says the grip; where the coefficient is 0 only the force is drawn.
void add_friction_cones(const Frame& frame, BodyId selected, RenderScene& out);

}  // namespace tumble
