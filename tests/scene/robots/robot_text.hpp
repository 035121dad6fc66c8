#pragma once
// Robot files as text, and what is read from them.
#include "engine/math/rotation.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/robot_files/mjcf_reader.hpp"
#include "engine/scene/robot_files/robot_parts.hpp"
#include "engine/scene/robot_files/urdf_reader.hpp"
#include "tests/scene/scene_text.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace tumble::test {

struct ReadRobot {
  RobotModel model;
  RobotLog log;
};

inline ReadRobot robot_of_text(const std::string& text, const std::string& name) {
  ReadRobot out;
  const auto root = parse_xml(text, name, out.log);
  if (!root) return out;
  out.model = root->name == "mujoco" ? read_mjcf(*root, name, out.log)
                                     : read_urdf(*root, name, {}, out.log);
  return out;
}
/// Links and joints of a <robot>, the first line of them in line 2.
inline ReadRobot urdf(const std::string& members) {
  return robot_of_text("<robot name=\"r\">\n" + members + "\n</robot>", "r.urdf");
}
inline ReadRobot mjcf(const std::string& members) {
  return robot_of_text("<mujoco model=\"m\">\n" + members + "\n</mujoco>", "m.xml");
}

inline std::string log_text(const RobotLog& log) {
  std::string out = all_text(log.faults());
  for (const std::string& w : log.warnings()) out += "\n" + w;
  return out;
}

inline bool warns(const RobotLog& log, const std::string& start, const std::string& part) {
  for (const std::string& w : log.warnings())
    if (w.starts_with(start) && w.find(part) != std::string::npos) return true;
  return false;
}

/// A folder that is gone at the end.
struct ScratchFolder {
  std::filesystem::path path;
  explicit ScratchFolder(const std::string& name)
      : path(std::filesystem::temp_directory_path() /
             fmt::format("tumble_{}_{}", name, ::getpid())) {
    std::filesystem::create_directories(path);
  }
  ~ScratchFolder() {
    std::error_code error;
    std::filesystem::remove_all(path, error);
  }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << text;
    return path / name;
  }
};

inline BuiltScene build_of(const SceneRead& read) {
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  WorldDef extras;
  extras.threads = 1;
  std::vector<Fault> faults;
  auto made = build_world(read.scene, extras, nullptr, &faults);
  INFO(all_text(faults));
  REQUIRE(made.ok());
  return std::move(*made);
}

}  // namespace tumble::test
