#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "viewer/interact/handles.hpp"

namespace tumble {

/// A body moved, rotated and scaled by handles. Its shapes are scaled, and with them a mass
/// computed from the shapes; a mass given in its definition stays. Scaling along one axis acts on
/// the axis of each shape that is nearest to it: a box gets longer, a cylinder higher or wider.
/// Fails for what can only be scaled uniformly: meshes, and inertia given as numbers.
Result<BodyDef> displaced(const BodyDef& def, const Displacement& way);

}  // namespace tumble
