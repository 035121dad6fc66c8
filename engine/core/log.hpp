#pragma once
#include <functional>
#include <string>
#include <string_view>

namespace tumble {

enum class LogLevel { debug, info, warning, error };

/// Receives the messages of one World or one loader; given in by the owner, never global.
using LogSink = std::function<void(LogLevel, std::string_view message)>;

/// Writes "tumble: warning: ..." lines to stderr, from `least` upwards.
LogSink stderr_log(LogLevel least = LogLevel::info);

}  // namespace tumble
