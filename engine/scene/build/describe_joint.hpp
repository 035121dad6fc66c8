#pragma once
#include "engine/scene/description/joint.hpp"

namespace tumble {

/// The description from which joint_defs() would make the coordinate's drive, without what only
/// files have: a motor whose target is a course has its present value, and the coupling of the
/// coordinate is left out. `angle`: the coordinate is an angle (JointCoordinate::angle), with
/// values in degrees.
DriveDescription describe_drive(const CoordinateDrive& drive, bool angle);

}  // namespace tumble
