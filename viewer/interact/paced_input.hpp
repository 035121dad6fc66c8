#pragma once
#include "viewer/interact/input.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Hands out input in portions of which each can be shown by one picture. The panels see only what
/// is held during a picture and all its text at once: when a picture takes long, a key that does
/// something to text (Ctrl+A, Backspace, Tab) and text that was typed after it would lose their
/// order. What does not fit waits for the next picture.
class PacedInput {
 public:
  void add(std::span<const InputEvent> events) {
    waiting_.insert(waiting_.end(), events.begin(), events.end());
  }
  /// The events of the next picture, in order; at least one if any is waiting.
  std::vector<InputEvent> take();

 private:
  size_t count_fitting() const;

  std::vector<InputEvent> waiting_;
};

}  // namespace tumble
