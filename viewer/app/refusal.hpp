#pragma once
#include "engine/core/error.hpp"

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace tumble {

/// Why the world refused what a person asked for: said by jobs on the simulation thread, which hold
/// a copy, and taken by the window, once.
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

 private:
  struct Shared {
    std::mutex mutex;
    std::optional<Error> error;
  };
  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
};

}  // namespace tumble
