#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "engine/scene/description/part.hpp"
#include "engine/scene/visitors/object_writer.hpp"

#include <string>

namespace tumble {

// Definitions of a world as values of a scene file. What is by default is left out.

/// On one line, with a space inside brackets, as scenes are written.
std::string one_line(const Json& value);

Json number_of(const ShapeDef& shape, const ShapeParameter& p);
/// The material by its name where it is a built-in one, else what differs from the default.
Json material_json(const Material& material);
/// Without its material.
Json shape_json(const BodyShapeDef& part);
Json body_json(const BodyDef& def);
Json drive_json(const CoordinateDrive& drive, bool angle);
Json part_json(const PartDescription& part);

}  // namespace tumble
