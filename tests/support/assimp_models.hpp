#pragma once
#include <algorithm>
#include <filesystem>
#include <vector>

#include <doctest/doctest.h>

namespace tumble {

/// Several hundred models of every format and fault that others made: package assimp-testmodels.
inline const std::filesystem::path assimp_models = "/usr/share/assimp/models";

/// Whether they are installed; says so if not.
inline bool have_assimp_models() {
  const bool there = std::filesystem::exists(assimp_models);
  if (!there) MESSAGE("package assimp-testmodels is not installed");
  return there;
}

/// All files among them, sorted.
inline std::vector<std::filesystem::path> assimp_model_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(assimp_models)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace tumble
