#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace tumble {

enum class Verdict : uint8_t {
  waiting,  ///< its moment has not come
  holds,    ///< it did at its moment; or always so far
  fails,
};

/// An assertion of a scene, and how it stands.
struct AssertionView {
  std::string title;         ///< "": its text says it
  std::string text;          ///< the condition
  std::optional<double> at;  ///< the moment, or from when on [s]; none: at the end, or the start
  bool always = false;
  Verdict verdict = Verdict::waiting;
  double decided = 0;  ///< when, if it does not wait [s]
  std::string values;  ///< where it fails: "name = value" of each quantity in it, a line each
};

/// "at 20 s", "always", "always from 2 s on", "at the end".
std::string when_text(const AssertionView& assertion);

}  // namespace tumble
