#include "engine/scene/robot_files/asset_paths.hpp"

#include <cstdlib>
#include <vector>

#include <fmt/format.h>

namespace tumble {
namespace {

namespace fs = std::filesystem;

bool is_plain_file(const fs::path& p) {
  std::error_code error;
  return fs::is_regular_file(p, error);
}

std::vector<fs::path> folders_of(const char* variable) {
  std::vector<fs::path> out;
  const char* value = std::getenv(variable);
  std::string rest = value ? value : "";
  while (!rest.empty()) {
    const size_t colon = rest.find(':');
    if (colon != 0) out.emplace_back(rest.substr(0, colon));
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return out;
}

/// Folders where a package may be, in the order of the search.
std::vector<fs::path> package_folders(const std::string& package, const fs::path& robot_file,
                                      const PackageFolders& packages) {
  std::vector<fs::path> out;
  if (const auto known = packages.find(package); known != packages.end())
    out.push_back(known->second);
  const auto in_or_itself = [&](const fs::path& folder) {
    if (folder.filename() == package) out.push_back(folder);
    out.push_back(folder / package);
  };
  for (const fs::path& folder : folders_of("ROS_PACKAGE_PATH")) in_or_itself(folder);
  for (const fs::path& folder : folders_of("AMENT_PREFIX_PATH"))
    out.push_back(folder / "share" / package);
  std::error_code error;
  for (fs::path folder = fs::absolute(robot_file, error).parent_path();;
       folder = folder.parent_path()) {
    in_or_itself(folder);
    if (folder == folder.parent_path()) break;
  }
  return out;
}

}  // namespace

std::optional<fs::path> find_asset(const std::string& name, const fs::path& robot_file,
                                   const PackageFolders& packages, const RobotPlace& at,
                                   RobotLog& log) {
  for (const std::string_view scheme : {"package://", "model://"}) {
    if (!name.starts_with(scheme)) continue;
    const std::string path = name.substr(scheme.size());
    const size_t slash = path.find('/');
    const std::string package = path.substr(0, slash);
    const std::string inside = slash == std::string::npos ? "" : path.substr(slash + 1);
    std::error_code error;
    bool known = false;
    for (const fs::path& folder : package_folders(package, robot_file, packages)) {
      if (is_plain_file(folder / inside)) return folder / inside;
      known = known || fs::is_directory(folder, error);
    }
    if (known)
      log.warn(at, fmt::format("there is no '{}' in the package '{}'", inside, package));
    else
      log.warn(at, fmt::format("there is no package '{0}', in ROS_PACKAGE_PATH or from the file "
                               "upwards, and so not this mesh of it (give the robot \"packages\": "
                               "{{\"{0}\": \"FOLDER\"}})",
                               package));
    return std::nullopt;
  }
  const std::string local = name.starts_with("file://") ? name.substr(7) : name;
  const fs::path file = robot_file.parent_path() / local;  // an absolute path is unchanged
  if (is_plain_file(file)) return file;
  log.warn(at, fmt::format("there is no file '{}'", file.string()));
  return std::nullopt;
}

}  // namespace tumble
