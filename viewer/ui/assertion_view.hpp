#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace tumble {

enum class Verdict : uint8_t {
  waiting,  ///< its time has not been reached
  holds,    ///< it held at its time, or (if it is to hold always) it has held so far
  fails,
};

/// An assertion of a scene and its outcome.
struct AssertionView {
  std::string title;         ///< "": the text is shown instead
  std::string text;          ///< the condition
  std::optional<double> at;  ///< the time at which, or from which on, it must hold [s]; none: at
                             ///< the end, or from the start
  bool always = false;
  Verdict verdict = Verdict::waiting;
  double decided = 0;  ///< time at which it was decided, unless waiting [s]
  std::string values;  ///< if it fails: "name = value" of each quantity in it, one per line
};

/// "at 20 s", "always", "always from 2 s on", "at the end".
std::string when_text(const AssertionView& assertion);

}  // namespace tumble
