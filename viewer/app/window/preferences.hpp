#pragma once
#include "engine/core/result.hpp"
#include "viewer/ui/style.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The user's preferences for the window, in all scenes.
struct Preferences {
  Theme theme = Theme::dark;
  double zoom = 1;  ///< scale of panels and text
  bool operator==(const Preferences&) const = default;
};
constexpr double least_zoom = 0.7, greatest_zoom = 2.5;

/// Files in $XDG_CONFIG_HOME/tumble (~/.config/tumble); empty if there is no home directory.
std::filesystem::path preferences_file();  ///< window.json, written by the program
std::filesystem::path keys_file();         ///< keys.json, written by the user

/// Parses a text such as `{"theme": "light", "scale": 1.2}`. Invalid values keep their defaults and
/// are reported in `faults`, one line each.
Preferences read_preferences(std::string_view json, std::vector<std::string>& faults);
Status write_preferences(const std::filesystem::path& file, const Preferences& preferences);

/// Reads and applies the user's key bindings, and returns the preferences. Faults name their file;
/// a missing file is not a fault.
Preferences take_up_user_files(std::vector<std::string>& faults);

}  // namespace tumble
