#pragma once
#include "engine/scene/robot_files/mjcf_settings.hpp"

namespace tumble {

/// A <geom>: what it collides as, how it is seen, what it weighs.
struct MjcfGeom {
  RobotGeometry geometry;
  bool collides = true, drawn = true;
  std::optional<MassProperties> mass;  ///< nothing: it has none
};

/// Nothing for what cannot be made, which has been said.
std::optional<MjcfGeom> read_mjcf_geom(const XmlElement& e, const std::string& body_class,
                                       const MjcfSettings& settings, RobotLog& log);

}  // namespace tumble
