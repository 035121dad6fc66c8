#pragma once
#include "engine/core/result.hpp"
#include "viewer/ui/style.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// How a person wants the window, in every scene.
struct Preferences {
  Theme theme = Theme::dark;
  double zoom = 1;  ///< of panels and text
  bool operator==(const Preferences&) const = default;
};
constexpr double least_zoom = 0.7, greatest_zoom = 2.5;

/// $XDG_CONFIG_HOME/tumble (~/.config/tumble) and the files there; empty where there is no home.
std::filesystem::path preferences_file();  ///< window.json, which the window writes
std::filesystem::path keys_file();         ///< keys.json, which a person writes

/// Of a text such as `{"theme": "light", "scale": 1.2}`; what is wrong keeps its usual value and is
/// said, a line each.
Preferences read_preferences(std::string_view json, std::vector<std::string>& faults);
Status write_preferences(const std::filesystem::path& file, const Preferences& preferences);

/// Bindings and preferences of this user, the bindings put to use. Faults name their file; a file
/// that is not there is none.
Preferences take_up_user_files(std::vector<std::string>& faults);

}  // namespace tumble
