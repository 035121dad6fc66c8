#include "engine/core/log.hpp"

#include <cstdio>

namespace tumble {

LogSink stderr_log(LogLevel least) {
  return [least](LogLevel level, std::string_view message) {
    if (level < least) return;
    const char* prefix = level == LogLevel::error     ? "error: "
                         : level == LogLevel::warning ? "warning: "
                                                      : "";
    std::fprintf(stderr, "tumble: %s%.*s\n", prefix, int(message.size()), message.data());
  };
}

}  // namespace tumble
