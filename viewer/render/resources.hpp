#pragma once
#include "engine/core/result.hpp"

#include <filesystem>
#include <string_view>

namespace tumble {

/// The path of a file or folder that comes with Tumble, such as "shaders"; it is found where scenes
/// are (engine/scene/resources.hpp), independently of the working directory. The error lists the
/// places that were tried.
Result<std::filesystem::path> resource_path(std::string_view relative);

}  // namespace tumble
