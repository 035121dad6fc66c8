#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "viewer/interact/handles.hpp"

namespace tumble {

/// A body moved, turned and grown as handles ask. Its shapes grow with it, and with them a mass
/// that is theirs; a mass that its definition names stays. What grows along one axis only grows
/// along the axis of each shape that is nearest to it: a box gets longer, a cylinder higher or
/// wider. Refused where a body cannot grow so: meshes, and inertia given as numbers, grow in all
/// directions alike.
Result<BodyDef> displaced(const BodyDef& def, const Displacement& way);

}  // namespace tumble
