#pragma once
#include "engine/scene/robot_files/robot_log.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace tumble {

/// Folders of packages by name, as the caller knows them.
using PackageFolders = std::map<std::string, std::filesystem::path, std::less<>>;

/// The file that a robot file means by `package://NAME/PATH`, `model://NAME/PATH`, `file://PATH` or
/// a path from its own folder. Packages are looked for among `packages`, in the folders of
/// ROS_PACKAGE_PATH, in share/ of those of AMENT_PREFIX_PATH, and in each folder from the robot
/// file upwards. Nothing where there is no such file, with a warning that says where it was looked
/// for and what to do.
std::optional<std::filesystem::path> find_asset(const std::string& name,
                                                const std::filesystem::path& robot_file,
                                                const PackageFolders& packages,
                                                const RobotPlace& at, RobotLog& log);

}  // namespace tumble
