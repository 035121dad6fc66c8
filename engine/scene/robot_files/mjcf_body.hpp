#pragma once
#include "engine/scene/robot_files/mjcf_settings.hpp"

namespace tumble {

/// Adds what a <worldbody> holds: its geoms as scenery, and its bodies.
void read_mjcf_world(const XmlElement& e, const MjcfSettings& settings, RobotModel& out,
                     RobotLog& log);

}  // namespace tumble
