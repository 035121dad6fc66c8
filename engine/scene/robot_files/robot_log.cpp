#include "engine/scene/robot_files/robot_log.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Limits for the faults and kinds of warnings that are kept per file, and for the lines that a
/// warning lists.
constexpr size_t most_faults = 100, most_warnings = 500, most_lines = 16;

}  // namespace

void RobotLog::fault(const RobotPlace& at, std::string message) {
  if (faults_.size() >= most_faults) return;
  faults_.push_back({at.file ? *at.file : std::string(), at.line, {}, std::move(message)});
}

void RobotLog::warn(const RobotPlace& at, const std::string& message) {
  const std::string file = at.file ? *at.file : std::string();
  const auto same = std::find_if(warnings_.begin(), warnings_.end(), [&](const Warning& w) {
    return w.message == message && w.file == file;
  });
  if (same == warnings_.end()) {
    if (warnings_.size() < most_warnings) warnings_.push_back({file, message, {at.line}});
  } else if (std::find(same->lines.begin(), same->lines.end(), at.line) == same->lines.end()) {
    same->lines.push_back(at.line);
  }
}

std::vector<std::string> RobotLog::warnings() const {
  std::vector<Warning> sorted = warnings_;
  for (Warning& w : sorted) std::sort(w.lines.begin(), w.lines.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const Warning& a, const Warning& b) {
    return a.lines.front() < b.lines.front();
  });
  std::vector<std::string> out;
  for (const Warning& w : sorted) {
    std::string text = w.file;
    if (w.lines.front() > 0) text += fmt::format(":{}", w.lines.front());
    text += ": " + w.message;
    const size_t listed = std::min(w.lines.size(), most_lines);
    for (size_t i = 1; i < listed; ++i)
      text += fmt::format("{}{}", i == 1 ? " (also in line " : ", ", w.lines[i]);
    if (w.lines.size() > listed) text += fmt::format(" and {} more", w.lines.size() - listed);
    if (listed > 1) text += ")";
    out.push_back(std::move(text));
  }
  return out;
}

}  // namespace tumble
