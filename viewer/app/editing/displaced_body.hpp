#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/scene/saving/scene_edits.hpp"
#include "viewer/interact/handles.hpp"

namespace tumble {

/// A body moved, rotated and scaled by handles. Its shapes are scaled, and with them a mass
/// computed from the shapes; a mass given in its definition stays. Scaling along one axis acts on
/// the axis of each shape that is nearest to it: a box gets longer, a cylinder higher or wider.
/// Fails for what can only be scaled uniformly: meshes, and inertia given as numbers.
Result<BodyDef> displaced(const BodyDef& def, const Displacement& way);

/// The change of a body that stands at the pose `now`, by which it gets the pose and velocities of
/// `wanted`. `known`: World::body_def(), whose pose is that at which its course begins, if it has
/// one. Put elsewhere, a body takes its course along before the first tick; once the run has
/// `begun` it leaves it.
ChangedBody changed_at(const BodyDef& known, const Pose& now, BodyDef wanted, bool begun);

}  // namespace tumble
