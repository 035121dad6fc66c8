#pragma once
#include "engine/scene/robot_files/asset_paths.hpp"
#include "engine/scene/robot_files/robot_model.hpp"
#include "engine/scene/robot_files/xml_file.hpp"

namespace tumble {

/// Reads a URDF robot (http://wiki.ros.org/urdf/XML, versions 1.0 to 1.2, and the capsule of 1.2).
/// Angles are in radians. Faults: what is malformed, names that are missing or given twice, links
/// that do not form one tree. Warnings: everything that is asked for and not followed.
RobotModel read_urdf(const XmlElement& root, const std::filesystem::path& file,
                     const PackageFolders& packages, RobotLog& log);

}  // namespace tumble
