#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "engine/scene/description/part.hpp"
#include "engine/scene/visitors/object_writer.hpp"

#include <string>

namespace tumble {

// Converts definitions of a world to JSON of a scene file. Default values are left out.

/// JSON on one line, with a space inside brackets, in the style of scene files.
std::string one_line(const Json& value);

Json number_of(const ShapeDef& shape, const ShapeParameter& p);
/// The name of a built-in material, or the values that differ from the default.
Json material_json(const Material& material);
/// The same as member of a body, which has the default where its file says none.
void put_material(Json& body, const Material& material);
/// Without its material.
Json shape_json(const BodyShapeDef& part);
Json body_json(const BodyDef& def);
Json drive_json(const CoordinateDrive& drive, bool angle);
Json part_json(const PartDescription& part);

}  // namespace tumble
