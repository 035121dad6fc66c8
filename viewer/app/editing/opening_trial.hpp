#pragma once
#include "engine/core/result.hpp"
#include "engine/core/stop.hpp"

#include <filesystem>
#include <future>
#include <optional>
#include <string>

namespace tumble {

/// Whether a text opens as a scene: its world is made, and thrown away. Given up with destruction.
class OpeningTrial {
 public:
  /// `beside`: on a thread of its own; else when it is asked for.
  OpeningTrial(std::string text, std::filesystem::path file, bool beside);
  ~OpeningTrial() { stop_.request(); }
  OpeningTrial(const OpeningTrial&) = delete;
  OpeningTrial& operator=(const OpeningTrial&) = delete;

  /// What came of it, once it is known, and once.
  std::optional<Status> take();

 private:
  StopFlag stop_;
  std::future<Status> outcome_;
};

}  // namespace tumble
