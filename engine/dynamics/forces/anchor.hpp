#pragma once
#include "engine/dynamics/forces/force_context.hpp"

namespace tumble {

/// dv/dp of the anchor's point: 1/m I - [r] I^-1 [r] for bodies, 1/m for particles, zero for the
/// world and for bodies that do not yield [1/kg].
Mat3 mobility(const Anchor& anchor, const ForceContext& context);

/// Adds a force [N] that acts at the anchor.
void add_force(const Anchor& anchor, const Vec3& force, ForceContext& context);

/// How far ahead springs look at this anchor; see ForceContext::lead.
double lead_of(const Anchor& anchor, const ForceContext& context);

}  // namespace tumble
