#pragma once
#include "engine/core/result.hpp"

#include <filesystem>
#include <string_view>

namespace tumble {

/// A file or folder that comes with Tumble, such as "shaders"; found where scenes are
/// (engine/scene/resources.hpp), never by the working directory. Fails naming what was tried.
Result<std::filesystem::path> resource_path(std::string_view relative);

}  // namespace tumble
