#include "viewer/interact/scripted_input.hpp"

#include <charconv>
#include <cstdlib>
#include <sstream>

namespace tumble {
namespace {

constexpr int patience_frames = 200;

std::optional<PointerButton> button_named(std::string_view name) {
  if (name == "left") return PointerButton::left;
  if (name == "right") return PointerButton::right;
  if (name == "middle") return PointerButton::middle;
  return std::nullopt;
}

std::optional<ScriptedInput::Point> as_point(const std::string& text) {
  char* end = nullptr;
  const double x = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != ',') return std::nullopt;
  const char* second = end + 1;
  const double y = std::strtod(second, &end);
  if (end == second || *end != 0) return std::nullopt;
  return ScriptedInput::Point{x, y};
}

/// Parses "Ctrl+Shift+." as key and modifiers.
std::pair<Key, uint8_t> parse_chord(std::string_view text) {
  uint8_t mods = Mods::none;
  for (;;) {
    const size_t plus = text.find('+');
    if (plus == std::string_view::npos || plus == 0 || plus + 1 == text.size()) break;
    const Key key = key_from_name(text.substr(0, plus));
    if (key == Key::shift)
      mods |= Mods::shift;
    else if (key == Key::control)
      mods |= Mods::ctrl;
    else if (key == Key::alt)
      mods |= Mods::alt;
    else
      return {Key::none, mods};
    text.remove_prefix(plus + 1);
  }
  if (text == "?") return {Key::slash, uint8_t(mods | Mods::shift)};
  return {key_from_name(text), mods};
}

InputEvent press_event(PointerButton button, bool down) {
  return PointerPressed{button, down};
}
InputEvent key_event(Key key, bool down) {
  return KeyPressed{key, down, false};
}

}  // namespace

Result<ScriptedInput> ScriptedInput::parse(std::string_view text) {
  ScriptedInput script;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (const size_t hash = line.find('#'); hash != std::string::npos) line.resize(hash);
    if (Status s = script.add(line); !s) {
      Error error = s.error();
      error.place = "line " + std::to_string(number);
      return error;
    }
  }
  return script;
}

void ScriptedInput::add_key(Key key, uint8_t mods) {
  Step down, up;
  const std::pair<uint8_t, Key> held[] = {
      {Mods::ctrl, Key::control}, {Mods::shift, Key::shift}, {Mods::alt, Key::alt}};
  for (const auto& [bit, k] : held)
    if (mods & bit) down.events.push_back(key_event(k, true));
  down.events.push_back(key_event(key, true));
  up.events.push_back(key_event(key, false));
  for (const auto& [bit, k] : held)
    if (mods & bit) up.events.push_back(key_event(k, false));
  steps_.push_back(std::move(down));
  steps_.push_back(std::move(up));
}

Status ScriptedInput::add(std::string_view line) {
  std::istringstream in{std::string(line)};
  std::string verb, place;
  if (!(in >> verb)) return {};
  const auto fail = [&](std::string_view why) -> Status {
    return Error{ErrorCode::parse, verb + ": " + std::string(why), {}, {}};
  };
  const auto rest = [&] {
    std::string words;
    std::getline(in >> std::ws, words);
    while (!words.empty() && words.back() == ' ') words.pop_back();
    return words;
  };
  const auto step = [&](std::vector<InputEvent> events, std::string to = {}) {
    steps_.push_back({std::move(events), std::move(to), false, 0, 0});
  };
  const auto click = [&](const std::string& to) {
    step({}, to);
    step({press_event(PointerButton::left, true)});
    step({press_event(PointerButton::left, false)});
  };
  if (verb == "wait") {
    int n = 0;
    if (!(in >> n) || n < 0 || n > 100000) return fail("how many frames?");
    for (int i = 0; i < n; ++i) step({});
  } else if (verb == "move" || verb == "click" || verb == "double_click" || verb == "shift_click") {
    if (!(in >> place)) return fail("where?");
    if (verb == "move") step({}, place);
    if (verb == "shift_click") {
      step({key_event(Key::shift, true)});
      click(place);
      step({key_event(Key::shift, false)});
    } else if (verb != "move") {
      click(place);
      if (verb == "double_click") click(place);
    }
  } else if (verb == "drag") {
    double dx = 0, dy = 0;
    int n = 20;
    if (!(in >> place >> dx >> dy)) return fail("PLACE DX DY [FRAMES]");
    if (!(in >> n)) n = 20;
    if (n < 1 || n > 100000) return fail("how many frames?");
    step({}, place);
    step({press_event(PointerButton::left, true)});
    for (int i = 0; i < n; ++i) steps_.push_back({{}, {}, true, dx / n, dy / n});
    step({press_event(PointerButton::left, false)});
  } else if (verb == "press" || verb == "release") {
    in >> place;
    const auto button = button_named(place);
    if (!button) return fail("left, right or middle");
    step({press_event(*button, verb == "press")});
  } else if (verb == "by") {
    double dx = 0, dy = 0;
    if (!(in >> dx >> dy)) return fail("DX DY");
    steps_.push_back({{}, {}, true, dx, dy});
  } else if (verb == "wheel") {
    double n = 0;
    if (!(in >> n)) return fail("how many notches?");
    step({WheelTurned{0, n}});
  } else if (verb == "key" || verb == "hold" || verb == "let") {
    in >> place;
    const auto [key, mods] = parse_chord(place);
    if (key == Key::none) return fail("unknown key '" + place + "'");
    if (verb == "key")
      add_key(key, mods);
    else
      step({key_event(key, verb == "hold")});
  } else if (verb == "text") {
    for (const char c : rest()) step({TextTyped{uint32_t(static_cast<unsigned char>(c))}});
  } else if (verb == "drop") {
    step({FilesDropped{{rest()}}});
  } else {
    return fail("unknown command");
  }
  return {};
}

Result<std::vector<InputEvent>> ScriptedInput::next(const Locate& locate) {
  std::vector<InputEvent> events;
  if (steps_.empty()) return events;
  Step& step = steps_.front();
  if (!step.place.empty()) {
    std::optional<Point> point = as_point(step.place);
    if (!point) point = locate(step.place);
    if (!point) {
      if (++waited_ < patience_frames) return events;
      return Error{ErrorCode::not_found, "'" + step.place + "' is nowhere in the picture", {}, {}};
    }
    at_ = *point;
    events.push_back(PointerMoved{at_.x, at_.y});
  } else if (step.offset_only) {
    at_.x += step.dx;
    at_.y += step.dy;
    events.push_back(PointerMoved{at_.x, at_.y});
  }
  waited_ = 0;
  events.insert(events.end(), step.events.begin(), step.events.end());
  steps_.pop_front();
  return events;
}

}  // namespace tumble
