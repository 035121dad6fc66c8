#pragma once
#include "engine/scene/robot_files/attributes.hpp"
#include "engine/scene/robot_files/robot_model.hpp"

#include <map>

namespace tumble {

/// A mesh of <asset>.
struct MjcfMesh {
  std::filesystem::path file;  ///< empty: it was not found, and that was reported
  Vec3 scale{1, 1, 1};
};
struct MjcfMaterial {
  Colour colour{1, 1, 1};
  double alpha = 1;
};

/// What a body's mass is computed from.
enum class MjcfInertia { automatic, geoms, inertial };

/// Settings for all elements of an MJCF file: <compiler>, <default>, <asset>.
struct MjcfSettings {
  std::filesystem::path file;
  std::filesystem::path mesh_folder;
  double angle = 0;  ///< radians of one unit
  std::string euler = "xyz";
  bool autolimits = true;
  bool strip_path = false;
  MjcfInertia inertia = MjcfInertia::automatic;
  double least_mass = 0, least_inertia = 0;  ///< [kg], [kg m2]
  std::optional<double> total_mass;          ///< [kg]
  std::map<std::string, MjcfMesh> meshes;
  std::map<std::string, MjcfMaterial> materials;

  explicit MjcfSettings(const std::filesystem::path& of) : file(of) {}
  /// Reads these elements of a file, wherever they are.
  void read(const XmlElement& root, RobotLog& log);

  /// Adds to an element the default attributes of its class, or else of that of the bodies around
  /// it.
  void set_defaults(Attributes& a, const std::string& element, const std::string& body_class,
                    RobotLog& log) const;
  /// `pos` and one of quat, axisangle, xyaxes, zaxis, euler.
  Pose read_pose(Attributes& a) const;

 private:
  using Values = std::map<std::string, Attributes::Value>;
  using Class = std::map<std::string, Values>;  ///< by element

  void read_compiler(const XmlElement& e, RobotLog& log);
  void read_class(const XmlElement& e, const std::string& parent, RobotLog& log);
  void read_assets(const XmlElement& e, RobotLog& log);

  std::map<std::string, Class> classes_;
  std::map<std::string, Colour> textures_;
};

/// The top class of defaults.
inline constexpr const char* mjcf_main_class = "main";

}  // namespace tumble
