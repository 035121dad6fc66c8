#include "viewer/context/backends.hpp"
#include "viewer/context/window_context.hpp"

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

/// "egl:3" -> 3; empty when it is not of that form.
std::optional<size_t> device_index(std::string_view name) {
  if (name.substr(0, 4) != "egl:") return {};
  size_t index = 0;
  const char* end = name.data() + name.size();
  const auto [at, fault] = std::from_chars(name.data() + 4, end, index);
  if (fault != std::errc() || at != end) return {};
  return index;
}

/// The backends to try for a name, in order; fails when EGL is asked for and has no device.
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

Made make(const std::string& name) {
  if (name == "surfaceless") return make_egl_surfaceless_context();
  if (name == "osmesa") return make_osmesa_context();
  if (name == "window") return make_hidden_window();
  if (const auto index = device_index(name)) return make_egl_device_context(*index);
  return Error{ErrorCode::invalid_argument, "unknown context '" + name + "'", "--context",
               fmt::format("known: {}", fmt::join(context_names(), ", "))};
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
  static const std::vector<std::string> names = {"auto",        "egl",    "egl:N",
                                                 "surfaceless", "osmesa", "window"};
  return names;
}

Result<ContextChoice> create_context(std::string_view name, const LogSink& log) {
  ContextChoice choice;
  for (const std::string& candidate : candidates(name, choice.attempts)) {
    Made made = make(candidate);
    if (!made) {
      if (made.error().code == ErrorCode::invalid_argument) return made.error();
      choice.attempts.push_back({candidate, false, made.error()});
      continue;
    }
    choice.attempts.push_back({candidate, true, {}});
    choice.context = std::move(*made);
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
