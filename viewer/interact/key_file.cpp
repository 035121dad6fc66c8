#include "viewer/interact/key_file.hpp"

#include "engine/core/text.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

/// The keys that the file assigns to one action.
struct Request {
  Action action;
  std::vector<Chord> chords;  ///< none: no key
};

std::vector<std::string> all_names() {
  std::vector<std::string> out;
  for (size_t i = 0; i < action_count; ++i) out.emplace_back(action_name(Action(i)));
  return out;
}

std::optional<Request> read_request(const std::string& name, const Json& value,
                                    std::vector<std::string>& faults) {
  const auto action = action_from_name(name);
  if (!action) {
    // A list of all actions would fill the window.
    const std::string words = unknown_name("action", name, all_names());
    faults.push_back(name + ": " + words.substr(0, words.find(" Known:")) +
                     " (`tumble keys` lists them)");
    return std::nullopt;
  }
  const Json list = value.is_array() ? value : Json::array({value});
  Request request{*action, {}};
  for (const Json& one : list) {
    if (!one.is_string()) {
      faults.push_back(name + ": must be a chord such as \"Ctrl+K\", or a list of them");
      return std::nullopt;
    }
    const std::string text = one.get<std::string>();
    if (text.empty()) continue;
    const auto chord = chord_from_text(text);
    if (!chord) {
      faults.push_back(
          fmt::format("{}: '{}' is no chord: write a key such as K, F5, Space or "
                      "PageUp, after Ctrl+, Alt+ or Shift+ if you like",
                      name, text));
      return std::nullopt;
    }
    const auto same = [&](const Chord& c) { return c.key == chord->key && c.mods == chord->mods; };
    if (std::ranges::none_of(request.chords, same)) request.chords.push_back(*chord);
  }
  return request;
}

const Binding& usual_of(Action action) {
  return *std::ranges::find(usual_bindings(), action, &Binding::action);
}

const Binding* owner_of(const std::vector<Binding>& all, const Chord& chord) {
  for (const Binding& b : all)
    if (b.key == chord.key && b.mods == chord.mods) return &b;
  return nullptr;
}

/// An action whose requested keys were not available keeps its default keys, as far as no other
/// action has them now.
void keep_usual(const std::vector<Request>& requests, const std::vector<Action>& granted,
                std::vector<Binding>& all) {
  for (const Request& request : requests) {
    if (request.chords.empty() || std::ranges::find(granted, request.action) != granted.end())
      continue;
    for (const Binding& usual : usual_bindings())
      if (usual.action == request.action && !owner_of(all, {usual.key, usual.mods}))
        all.push_back(usual);
  }
}

/// Applies the requests to the table; a chord that another request already has is left out.
void grant(const std::vector<Request>& requests, std::vector<Binding>& all,
           std::vector<std::string>& faults) {
  for (const Request& request : requests)
    std::erase_if(all, [&](const Binding& b) { return b.action == request.action; });
  std::vector<Action> wished;
  for (const Request& request : requests) {
    for (const Chord& chord : request.chords) {
      Binding binding = usual_of(request.action);
      binding.key = chord.key;
      binding.mods = chord.mods;
      if (const Binding* other = owner_of(all, chord)) {
        const bool both = std::ranges::find(wished, other->action) != wished.end();
        faults.push_back(fmt::format(
            "{}: {} is {} already: give {} another key, or \"\" for none",
            action_name(request.action), chord_text(binding), action_name(other->action),
            both ? "one of them" : std::string(action_name(other->action))));
        continue;
      }
      all.push_back(binding);
      wished.push_back(request.action);
    }
  }
  keep_usual(requests, wished, all);
}

}  // namespace

std::optional<Chord> chord_from_text(std::string_view text) {
  Chord out;
  if (text == "?") return Chord{Key::slash, Mods::shift};
  constexpr std::pair<std::string_view, uint8_t> mods[] = {
      {"ctrl+", Mods::ctrl}, {"alt+", Mods::alt}, {"shift+", Mods::shift}};
  const auto begins = [&](std::string_view word) {
    return text.size() > word.size() &&
           std::ranges::equal(text.substr(0, word.size()), word, [](char a, char b) {
             return (a >= 'A' && a <= 'Z' ? char(a - 'A' + 'a') : a) == b;
           });
  };
  for (bool found = true; found;) {
    found = false;
    for (const auto& [word, bit] : mods)
      if (begins(word)) {
        out.mods |= bit;
        text.remove_prefix(word.size());
        found = true;
      }
  }
  out.key = key_from_name(text);
  const bool modifier = out.key == Key::shift || out.key == Key::control || out.key == Key::alt ||
                        out.key == Key::super;
  if (out.key == Key::none || modifier) return std::nullopt;
  return out;
}

std::vector<Binding> read_key_file(std::string_view text, std::vector<std::string>& faults) {
  std::vector<Binding> all(usual_bindings().begin(), usual_bindings().end());
  Json json;
  try {
    json = Json::parse(text, nullptr, true, true);
  } catch (const Json::parse_error& e) {
    // The byte at which parsing stopped, counted from 1.
    const std::string_view read =
        text.substr(0, std::min(e.byte > 0 ? e.byte - 1 : 0, text.size()));
    const auto line = std::ranges::count(read, '\n') + 1;
    const size_t column = read.size() - (read.rfind('\n') + 1) + 1;
    faults.push_back(fmt::format(
        "line {}, column {}: this is not JSON, a comma, a quote or a bracket may be missing or one "
        "too many. The usual keys hold",
        line, column));
    return all;
  } catch (const Json::exception&) {
    faults.push_back("a number in it is too large. The usual keys hold");
    return all;
  }
  if (!json.is_object()) {
    faults.push_back("must be an object such as {\"toggle_pause\": \"F2\"}");
    return all;
  }
  std::vector<Request> requests;
  for (const auto& [name, value] : json.items())
    if (auto request = read_request(name, value, faults)) requests.push_back(*std::move(request));
  grant(requests, all, faults);
  // Sorted like the default bindings, for the help.
  std::ranges::stable_sort(all, {}, [](const Binding& b) {
    return std::ranges::find(usual_bindings(), b.action, &Binding::action) -
           usual_bindings().begin();
  });
  return all;
}

}  // namespace tumble
