#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// The sensors that a described sensor stands for, in a world whose bodies and particles exist.
/// Errors: something that it names does not exist.
Result<std::vector<SensorDef>> sensor_defs(const std::string& name, const SensorDescription& sensor,
                                           const BuiltScene& built);

}  // namespace tumble
