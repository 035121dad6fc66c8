#include "viewer/context/backends.hpp"
#include "viewer/context/window_context.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

namespace tumble {
namespace {

using Made = Result<std::unique_ptr<GlContext>>;

Made make_hidden_window() {
  WindowOptions options;
  options.visible = false;
  options.vsync = false;
  auto window = make_window_context(options);
  if (!window) return window.error();
  return std::unique_ptr<GlContext>(std::move(*window));
}

/// "egl:3" -> 3; empty if it does not have that form.
std::optional<size_t> device_index(std::string_view name) {
  if (name.substr(0, 4) != "egl:") return {};
  size_t index = 0;
  const char* end = name.data() + name.size();
  const auto [at, fault] = std::from_chars(name.data() + 4, end, index);
  if (fault != std::errc() || at != end) return {};
  return index;
}

/// "egl:nvidia" -> "nvidia"; empty if it does not have that form.
std::string_view device_word(std::string_view name) {
  const bool by_word = name.substr(0, 4) == "egl:" && !device_index(name);
  return by_word ? name.substr(4) : std::string_view{};
}

/// Whether a text contains a word, ignoring case.
bool mentions(std::string_view text, std::string_view word) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
  return std::search(text.begin(), text.end(), word.begin(), word.end(),
                     [&](char a, char b) { return lower(a) == lower(b); }) != text.end();
}

/// The first EGL device whose file, vendor or renderer contains the word. The renderer is only
/// known after opening a device, so they are opened in turn.
Made make_named_device(std::string_view word, std::vector<ContextAttempt>& attempts) {
  const auto devices = egl_devices();
  if (!devices) return devices.error();
  std::string seen;
  for (size_t i = 0; i < devices->size(); ++i) {
    const EglPlace& place = (*devices)[i];
    Made made = make_egl_device_context(i);
    const std::string text = made ? fmt::format("{}, {}, {}", place.detail, (*made)->info().vendor,
                                                (*made)->info().renderer)
                                  : place.detail;
    if (mentions(text, word)) return made;
    if (!made) attempts.push_back({place.name, false, made.error()});
    seen += fmt::format("{}{} ({})", seen.empty() ? "" : "; ", place.name, text);
  }
  return Error{ErrorCode::invalid_argument,
               fmt::format("no EGL device is called anything with '{}'", word), "--context",
               "there are " + seen};
}

/// The backends to try for a name, in order; fails if EGL is requested and has no device.
std::vector<std::string> candidates(std::string_view name, std::vector<ContextAttempt>& attempts) {
  if (name != "auto" && name != "egl") return {std::string(name)};
  std::vector<std::string> out;
  if (auto devices = egl_devices()) {
    for (const EglPlace& place : *devices) out.push_back(place.name);
  } else {
    attempts.push_back({"egl", false, devices.error()});
  }
  if (name == "auto") {
    out.push_back("surfaceless");
    out.push_back("osmesa");
  }
  return out;
}

Error unknown_context(std::string_view name) {
  return Error{ErrorCode::invalid_argument, fmt::format("unknown context '{}'", name), "--context",
               fmt::format("known: {}", fmt::join(context_names(), ", "))};
}

Made make(const std::string& name) {
  if (name == "surfaceless") return make_egl_surfaceless_context();
  if (name == "osmesa") return make_osmesa_context();
  if (name == "window") return make_hidden_window();
  if (const auto index = device_index(name)) return make_egl_device_context(*index);
  return unknown_context(name);
}

Error no_context(std::string_view name, const std::vector<ContextAttempt>& attempts) {
  if (attempts.size() == 1) return attempts[0].error;
  std::string lines;
  for (const ContextAttempt& a : attempts)
    lines += fmt::format("\n  {}: {}", a.name, a.error.text());
  return Error{ErrorCode::unsupported,
               fmt::format("no OpenGL context for '{}'; tried:{}", name, lines), "",
               "`tumble doctor` tests every way to draw"};
}

}  // namespace

const std::vector<std::string>& context_names() {
  static const std::vector<std::string> names = {"auto",        "egl",    "egl:N", "egl:NAME",
                                                 "surfaceless", "osmesa", "window"};
  return names;
}

Status check_context_name(std::string_view name) {
  const auto& names = context_names();
  const bool device = device_index(name) || !device_word(name).empty();
  if (device || std::find(names.begin(), names.end(), name) != names.end()) return {};
  return unknown_context(name);
}

Result<ContextChoice> create_context(std::string_view name, const LogSink& log) {
  ContextChoice choice;
  for (const std::string& candidate : candidates(name, choice.attempts)) {
    const std::string_view word = device_word(candidate);
    Made made = word.empty() ? make(candidate) : make_named_device(word, choice.attempts);
    if (!made) {
      if (made.error().code == ErrorCode::invalid_argument) return made.error();
      choice.attempts.push_back({candidate, false, made.error()});
      continue;
    }
    choice.context = std::move(*made);
    choice.attempts.push_back({choice.context->info().name, true, {}});
    break;
  }
  if (!choice.context) return no_context(name, choice.attempts);
  if (log) {
    for (const ContextAttempt& a : choice.attempts)
      if (!a.ok) log(LogLevel::warning, fmt::format("{} is not used: {}", a.name, a.error.text()));
    const ContextInfo& i = choice.context->info();
    log(LogLevel::info,
        fmt::format("drawing on {}{}: {}, OpenGL {}", i.name,
                    i.detail.empty() ? "" : " (" + i.detail + ")", i.renderer, i.version));
  }
  return choice;
}

}  // namespace tumble
