#pragma once
#include "engine/core/result.hpp"

#include <filesystem>
#include <string_view>

namespace tumble {

/// Where shaders/, scenes/ and assets/ are: $TUMBLE_DATA, else share/tumble beside the running
/// program's bin/, else the source tree that it was built from, else the install prefix; never the
/// working directory. Fails naming every place that was tried.
Result<std::filesystem::path> resource_root();

/// root / relative, which must exist. Example: resource_path("shaders").
Result<std::filesystem::path> resource_path(std::string_view relative);

}  // namespace tumble
