#include "viewer/app/command.hpp"
#include "viewer/app/options.hpp"
#include "viewer/app/window/preferences.hpp"
#include "viewer/interact/key_map.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

std::vector<std::string> chords_of(Action action, std::span<const Binding> bindings) {
  std::vector<std::string> out;
  for (const Binding& b : bindings)
    if (b.action == action) out.push_back(chord_text(b));
  return out;
}

void print_table() {
  std::string_view group;
  std::vector<Action> done;
  for (const Binding& b : usual_bindings()) {
    if (std::ranges::find(done, b.action) != done.end()) continue;
    done.push_back(b.action);
    if (b.group != group) {
      fmt::print("{}{}\n", group.empty() ? "" : "\n", b.group);
      group = b.group;
    }
    const auto chords = chords_of(b.action, all_bindings());
    const auto usual = chords_of(b.action, usual_bindings());
    std::string text = fmt::format("{}", fmt::join(chords, ", "));
    if (text.empty()) text = "-";
    const std::string was =
        chords == usual ? "" : fmt::format(" (usually {})", fmt::join(usual, ", "));
    fmt::print("  {:<24} {:<16} {}{}\n", action_name(b.action), text, b.doc, was);
  }
}

void print_keys_json(const std::vector<std::string>& faults) {
  nlohmann::ordered_json out = {{"file", keys_file().string()},
                                {"keys", nlohmann::ordered_json::array()}};
  std::vector<Action> done;
  for (const Binding& b : usual_bindings()) {
    if (std::ranges::find(done, b.action) != done.end()) continue;
    done.push_back(b.action);
    out["keys"].push_back({{"action", action_name(b.action)},
                           {"chords", chords_of(b.action, all_bindings())},
                           {"usual", chords_of(b.action, usual_bindings())},
                           {"group", b.group},
                           {"doc", b.doc}});
  }
  out["faults"] = faults;
  fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

int run_keys(bool json) {
  std::vector<std::string> faults;
  (void)take_up_user_files(faults);
  json ? print_keys_json(faults) : print_table();
  for (const std::string& fault : faults) fmt::print(stderr, "{}\n", fault);
  return faults.empty() ? exit_ok : exit_bad_input;
}

}  // namespace

CommandAction declare_keys(Options& options) {
  auto json = std::make_shared<bool>(false);
  options.flag("--json", *json, "one JSON object on stdout");
  options.footer(
      "Other keys are written into $XDG_CONFIG_HOME/tumble/keys.json "
      "(~/.config/tumble/keys.json):\n\n"
      "  {\n"
      "    \"toggle_pause\": \"P\",\n"
      "    \"toggle_measure\": [\"Ctrl+P\", \"F2\"],\n"
      "    \"quit\": \"\"\n"
      "  }\n\n"
      "What is named there has these keys and no others; \"\" is none. 3 when something in it is "
      "wrong:\n"
      "then it is said, and the rest holds.");
  return [json] { return run_keys(*json); };
}

}  // namespace tumble
