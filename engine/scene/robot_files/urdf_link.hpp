#pragma once
#include "engine/scene/robot_files/asset_paths.hpp"
#include "engine/scene/robot_files/robot_model.hpp"
#include "engine/scene/robot_files/xml_file.hpp"

#include <map>

namespace tumble {

/// Colours by name: a <material> is declared at the top or at its first use.
class UrdfMaterials {
 public:
  /// Reads a <material>; returns its colour, or that of the name it refers to.
  std::optional<Colour> add(const XmlElement& e, RobotLog& log);

 private:
  std::map<std::string, Colour> colours_;
};

/// Where the meshes of a file are.
struct UrdfFiles {
  std::filesystem::path file;
  const PackageFolders& packages;
};

/// <origin>: xyz, and rpy about fixed axes, R = Rz(yaw) Ry(pitch) Rx(roll).
Pose read_urdf_origin(const XmlElement& e, RobotLog& log);
RobotLink read_urdf_link(const XmlElement& e, UrdfMaterials& materials, const UrdfFiles& files,
                         RobotLog& log);

}  // namespace tumble
