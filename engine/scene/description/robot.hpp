#pragma once
#include "engine/scene/description/parameter.hpp"
#include "engine/scene/description/placement.hpp"
#include "engine/scene/robot_files/robot_base.hpp"

namespace tumble {

template <>
struct EnumNames<RobotBase> {
  static constexpr std::array<std::pair<std::string_view, RobotBase>, 3> values = {
      {{"file", RobotBase::file}, {"fixed", RobotBase::fixed}, {"floating", RobotBase::floating}}};
};
template <>
struct EnumNames<RobotMotors> {
  static constexpr std::array<std::pair<std::string_view, RobotMotors>, 2> values = {
      {{"hold", RobotMotors::hold}, {"file", RobotMotors::file}}};
};

/// A folder. In a file a bare string stands for {"folder": string}.
struct PackageDescription {
  std::string folder;
  static constexpr std::string_view schema_name = "package";
  static constexpr std::string_view shorthand_key = "folder";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.folder, {.name = "folder",
                       .required = true,
                       .doc = "where the package is, from the scene's folder"});
  }
};

/// A coordinate of a robot's joint. In a file a bare number stands for {"value": number}.
struct CoordinateDescription {
  double value = 0;
  static constexpr std::string_view schema_name = "robot_coordinate";
  static constexpr std::string_view shorthand_key = "value";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(
        d.value,
        {.name = "value", .min = -1e7, .max = 1e7, .required = true, .doc = "of the coordinate"});
  }
};

/// A robot from a file of its own. It is replaced by its bodies, joints and meshes, whose names are
/// prefixed by its name and _.
struct RobotDescription {
  std::string file;
  Placement placement;
  RobotBase base = RobotBase::file;
  RobotMotors motors = RobotMotors::hold;
  bool self_collision = true;
  std::optional<std::string> prefix;
  NamedList<PackageDescription> packages;
  NamedList<CoordinateDescription> start, start_deg, target, target_deg;

  static constexpr std::string_view schema_name = "robot";
  static constexpr std::string_view shorthand_key = "file";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.file, {.name = "file",
                     .required = true,
                     .doc = "URDF (.urdf, .urdf.gz) or MJCF (.xml, .mjcf), from the scene's "
                            "folder; its z axis points up"});
    v.part(d.placement);
    v.field(d.base, {.name = "base",
                     .doc = "whether its first link stays: as the file says, fixed, or floating"});
    v.field(d.motors, {.name = "motors",
                       .doc = "hold: a motor holds each joint of a URDF where it starts; file: "
                              "there are only the file's own, a URDF has none"});
    v.field(d.self_collision,
            {.name = "self_collision",
             .doc = "whether its links collide with each other; neighbours, and those that "
                    "overlap at the start, never do"});
    v.field(d.prefix, {.name = "prefix",
                       .doc = "what the names of its parts begin with, instead of its name and _"});
    v.map(d.packages, {.name = "packages", .doc = "folders of package:// by name"});
    v.map(d.start,
          {.name = "start", .unit = "m", .doc = "where sliding joints start, by the file's names"});
    v.map(d.start_deg, {.name = "start_deg",
                        .unit = "deg",
                        .doc = "where turning joints start, by the file's names"});
    v.map(d.target, {.name = "target",
                     .unit = "m",
                     .doc = "where motors pull sliding joints, by the file's names"});
    v.map(d.target_deg, {.name = "target_deg",
                         .unit = "deg",
                         .doc = "where motors pull turning joints, by the file's names"});
  }
};

/// The parts of a scene that must be read before its robots.
struct RobotsOfScene {
  NamedList<ParameterDescription> parameters_;
  NamedList<RobotDescription> robots;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.map(d.parameters_, {.name = "parameters"});
    v.map(d.robots, {.name = "robots"});
  }
};

}  // namespace tumble
