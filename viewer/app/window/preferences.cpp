#include "viewer/app/window/preferences.hpp"

#include "engine/core/text.hpp"
#include "engine/scene/resources.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/interact/key_map.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace fs = std::filesystem;
namespace {

constexpr size_t most_file_bytes = 1 << 20;

fs::path user_file(const char* name) {
  const fs::path folder = user_folder("XDG_CONFIG_HOME", ".config");
  return folder.empty() ? fs::path() : folder / "tumble" / name;
}

/// Content of a file; empty if it does not exist.
std::string text_if_there(const fs::path& file, std::vector<std::string>& faults) {
  std::error_code none;
  if (file.empty() || !fs::exists(file, none)) return {};
  auto text = read_file(file, most_file_bytes);
  if (text) return *std::move(text);
  faults.push_back(text.error().text());
  return {};
}

}  // namespace

fs::path preferences_file() {
  return user_file("window.json");
}
fs::path keys_file() {
  return user_file("keys.json");
}

Preferences read_preferences(std::string_view text, std::vector<std::string>& faults) {
  Preferences out;
  const auto json = nlohmann::json::parse(text, nullptr, false, true);
  if (!json.is_object()) {
    faults.emplace_back("must be an object such as {\"theme\": \"light\", \"scale\": 1.2}");
    return out;
  }
  for (const auto& [name, value] : json.items()) {
    if (name == "theme") {
      const std::string said = value.is_string() ? value.get<std::string>() : value.dump();
      const auto known = std::ranges::find(theme_names, std::string_view(said));
      if (known != std::end(theme_names))
        out.theme = Theme(known - std::begin(theme_names));
      else
        faults.push_back(fmt::format("theme: '{}' is none: write \"dark\" or \"light\"", said));
    } else if (name == "scale") {
      const double zoom = value.is_number() ? value.get<double>() : 0;
      if (zoom >= least_zoom && zoom <= greatest_zoom)
        out.zoom = zoom;
      else
        faults.push_back(fmt::format("scale: must be a number from {} to {}, got {}", least_zoom,
                                     greatest_zoom, value.dump()));
    } else {
      faults.push_back(name + ": " +
                       unknown_name("key", name, std::vector<std::string>{"theme", "scale"}));
    }
  }
  return out;
}

Status write_preferences(const fs::path& file, const Preferences& preferences) {
  if (file.empty()) return {};
  if (Status made = make_folder(file.parent_path()); !made) return made;
  const std::string text = fmt::format("{{\n  \"theme\": \"{}\",\n  \"scale\": {:.3g}\n}}\n",
                                       theme_names[size_t(preferences.theme)], preferences.zoom);
  return write_file(file, std::string_view(text));
}

Preferences take_up_user_files(std::vector<std::string>& faults) {
  const auto named = [&faults](const fs::path& file, const std::vector<std::string>& found) {
    for (const std::string& fault : found) faults.push_back(file.string() + ": " + fault);
  };
  if (const std::string text = text_if_there(keys_file(), faults); !text.empty())
    named(keys_file(), take_bindings(text));
  const std::string text = text_if_there(preferences_file(), faults);
  if (text.empty()) return {};
  std::vector<std::string> found;
  const Preferences out = read_preferences(text, found);
  named(preferences_file(), found);
  return out;
}

}  // namespace tumble
