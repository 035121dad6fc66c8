#pragma once
#include "engine/scene/robot_files/robot_model.hpp"

#include <optional>

namespace tumble {

/// The inertia that a file gives a link, about its centre of mass in the link's axes, and where.
struct GivenInertia {
  std::optional<Mat3> tensor;
  RobotPlace at;
};

/// Sets the inertia of a link whose mass and centre are known: the given one, made physical if it
/// is not (with a warning that names the principal moments), else that of its geometry, evenly
/// filled, else that of a ball of water.
void complete_mass(RobotLink& link, const GivenInertia& given, RobotLog& log);

/// Mass properties of a geometry filled with a density, in the link's frame. Open meshes: of their
/// hull. Nothing for planes and for meshes that cannot be read.
std::optional<MassProperties> mass_of(const RobotGeometry& geometry, double density);

}  // namespace tumble
