#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/continuous_tests/moving.hpp"

#include <optional>

namespace tumble {

/// When a moving vertex (A) and a moving triangle (B) first come within `separation` >= 0 [m] of
/// each other, both sides of the triangle and its border included; nothing when they never do.
///
/// No contact is ever missed. With separation 0 the method is the cubic of coplanarity (Provot,
/// "Collision and self-collision handling in cloth model dedicated to design garments", 1997) in
/// Bernstein form with forward error bounds, split at its extrema; where a sign is in doubt, and
/// for every other separation, the march of `moving_hull.hpp`. Triangles without area, coplanar
/// motion and rest are no exceptions. Any magnitude of coordinates. Refuses non-finite ones and a
/// negative separation.
Result<std::optional<MovingContact>> vertex_face_contact(const MovingPoint& vertex,
                                                         const MovingTriangle& face,
                                                         double separation = 0);

}  // namespace tumble
