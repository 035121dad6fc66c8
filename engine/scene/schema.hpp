#pragma once
#include <string>

namespace tumble {

/// The JSON Schema (draft 7) of scene files, made from the declarations of SceneDescription. It is
/// kept at scenes/tumble.schema.json, where editors find it.
std::string scene_schema();

}  // namespace tumble
