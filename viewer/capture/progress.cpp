#include "viewer/capture/progress.hpp"

#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace tumble {
namespace {

std::string time_text(double seconds) {
  const auto s = uint64_t(seconds + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
  return fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

}  // namespace

Progress::Progress(uint64_t total, uint64_t first)
    : terminal_(::isatty(STDERR_FILENO) != 0),
      total_(total),
      first_(first),
      start_(Clock::now()),
      last_(start_) {}

void Progress::show(uint64_t done) {
  const auto now = Clock::now();
  const double pause = std::chrono::duration<double>(now - last_).count();
  if (done < total_ && pause < (terminal_ ? 0.1 : 5.0)) return;
  last_ = now;
  const double spent = std::chrono::duration<double>(now - start_).count();
  const double rate = spent > 0 ? double(done - first_) / spent : 0;
  std::string line = fmt::format("frame {}/{}, {:.1f} frames/s", done, total_, rate);
  if (done < total_ && rate > 0)
    line += fmt::format(", {} left", time_text(double(total_ - done) / rate));
  if (terminal_)
    fmt::print(stderr, "\r{:<60}", line);
  else
    fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
  open_ = terminal_;
}

WorkProgress::WorkProgress(std::string what)
    : what_(std::move(what)),
      terminal_(::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {}

void WorkProgress::show(double share, const std::string& more) {
  const auto now = Clock::now();
  if (std::chrono::duration<double>(now - last_).count() < (terminal_ ? 0.1 : 5.0)) return;
  last_ = now;
  const double spent = std::chrono::duration<double>(now - start_).count();
  std::string line = what_;
  if (!more.empty()) line += ", " + more;
  line += fmt::format(", {:.0f} %", 100 * share);
  if (share > 0) line += fmt::format(", about {} left", time_text(spent * (1 - share) / share));
  fmt::print(stderr, "{}", terminal_ ? fmt::format("\r{:<70}", line) : line + "\n");
  std::fflush(stderr);
  open_ = terminal_;
}

void WorkProgress::finish() {
  if (open_) fmt::print(stderr, "\n");
  open_ = false;
}

void Progress::finish() {
  if (open_) fmt::print(stderr, "\n");
  open_ = false;
}

}  // namespace tumble
