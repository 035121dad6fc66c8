#pragma once
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace tumble {

/// The program as built beside the tests.
inline ProgramRun tumble_program(const std::vector<std::string>& arguments,
                                 ProgramOptions options = {}) {
  // Never the developer's own display, so that a test opens no window.
  options.environment.insert(options.environment.begin(),
                             {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}});
  return run_program(std::filesystem::path(TUMBLE_BINARY_DIR) / "bin/tumble", arguments, options);
}

/// A ball and a box that fall on a floor.
inline std::string small_scene() {
  return R"({
  "tumble_scene": 1,
  "title": "small",
  "bodies": {
    "floor": {"type": "static", "shape": {"type": "half_space"}},
    "ball": {"position": [0, 1, 0], "shape": {"type": "sphere", "radius": 0.25}},
    "box": {"position": [0.6, 0.8, 0], "shape": {"type": "box", "size": [0.4, 0.4, 0.4]},
            "repeat": [{"type": "stack", "count": 3, "step": [0, 0.5, 0]}]}
  },
  "cameras": {"main": {"position": [2, 1.5, 3], "target": [0, 0.5, 0]},
              "top": {"position": [0, 6, 0.1], "target": [0, 0, 0]}}
})";
}

inline std::string write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
  return file.string();
}

/// Names of the files in a folder, hidden ones too, sorted.
inline std::vector<std::string> files_of(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code code;
  for (std::filesystem::directory_iterator it(folder, code), end; !code && it != end;
       it.increment(code))
    names.push_back(it->path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

inline bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace tumble
