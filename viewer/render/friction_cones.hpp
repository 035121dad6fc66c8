#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/render_scene.hpp"

namespace tumble {

/// State of a contact in the last tick, derived from its impulse.
enum class ContactGrip : uint8_t {
  none,   ///< no impulse: the bodies do not press on each other
  stick,  ///< inside the cone
  slide,  ///< on the cone to six digits: friction is at its maximum
};
ContactGrip grip_of(const ContactFrame& contact);

/// Adds Coulomb's friction cone at every contact point with a normal impulse; only those of the
/// `selected` body if there is one. The apex is the contact point, the axis the normal, and the
/// tangent of the half angle the coefficient of friction. The thick line inside is the contact
/// force: along the axis if there is no friction, on the cone if the contact slides. All cones of a
/// picture have the same slant length. The colour tells the state (ContactGrip); with a coefficient
/// of 0 only the force is drawn.
void add_friction_cones(const Frame& frame, BodyId selected, RenderScene& out);

}  // namespace tumble
