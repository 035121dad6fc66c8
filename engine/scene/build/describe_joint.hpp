#pragma once
#include "engine/scene/description/joint.hpp"

namespace tumble {

/// What joint_defs() made the coordinate's drive from, but for what only files know: a motor whose
/// target is a course has the value of now, and what couples the coordinate is left out. `angle`:
/// the coordinate is one (JointCoordinate::angle), its values in degrees.
DriveDescription describe_drive(const CoordinateDrive& drive, bool angle);

}  // namespace tumble
