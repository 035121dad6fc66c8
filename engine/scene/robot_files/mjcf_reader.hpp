#pragma once
#include "engine/scene/robot_files/robot_model.hpp"
#include "engine/scene/robot_files/xml_file.hpp"

namespace tumble {

/// Reads a subset of MJCF (https://mujoco.readthedocs.io/en/stable/XMLreference.html): bodies with
/// joints, geoms and inertials; actuators of kind motor, position and velocity, at control 0;
/// classes of defaults; equality constraints connect and weld; contact excludes; meshes; include.
/// Faults: what is malformed, names that are missing or given twice. Warnings: everything that is
/// asked for and not followed.
RobotModel read_mjcf(const XmlElement& root, const std::filesystem::path& file, RobotLog& log);

}  // namespace tumble
