#pragma once
#include "engine/core/error.hpp"

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Reports why the world rejected what the user requested, and what else a request changed. Written
/// by jobs on the simulation thread, which hold a copy, and read once by the window.
class Refusal {
 public:
  void say(const Error& error) const {
    std::lock_guard lock(shared_->mutex);
    shared_->error = error;
  }
  std::optional<Error> take() const {
    std::lock_guard lock(shared_->mutex);
    return std::exchange(shared_->error, {});
  }
  /// Reports what was changed besides what was requested.
  void tell(std::vector<std::string> lines) const {
    std::lock_guard lock(shared_->mutex);
    shared_->told = std::move(lines);
  }
  std::vector<std::string> take_told() const {
    std::lock_guard lock(shared_->mutex);
    return std::exchange(shared_->told, {});
  }

  /// The scene's file as it would be without what was taken away.
  void leave(std::string text) const {
    std::lock_guard lock(shared_->mutex);
    shared_->left = std::move(text);
  }
  std::optional<std::string> take_left() const {
    std::lock_guard lock(shared_->mutex);
    return std::exchange(shared_->left, {});
  }

 private:
  struct Shared {
    std::mutex mutex;
    std::optional<Error> error;
    std::vector<std::string> told;
    std::optional<std::string> left;
  };
  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
};

}  // namespace tumble
