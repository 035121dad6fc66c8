#pragma once
#include "engine/core/result.hpp"
#include "viewer/interact/input.hpp"

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Input played from a text, one pointer step per frame, so that the same script gives the same
/// picture on a window, EGL, OSMesa and the null device. One command a line; `#` starts a comment:
///
///     wait N                     N frames without input
///     move PLACE                 pointer to a place
///     click PLACE | double_click PLACE | shift_click PLACE
///     drag PLACE DX DY [N]       left button held, N frames long (20), by (DX, DY) px
///     press BUTTON, release BUTTON     left, right, middle; `by DX DY` moves in between
///     wheel N
///     key CHORD                  "Space", "Ctrl+O", "Shift+."
///     hold KEY, let KEY
///     text WORDS
///     drop FILE
///
/// PLACE is `X,Y` in UI units, a widget's name (`transport.pause`) or `body:NAME`.
class ScriptedInput {
 public:
  struct Point {
    double x = 0, y = 0;
  };
  /// Position of a widget or body in this frame's picture; empty if it is not visible.
  using Locate = std::function<std::optional<Point>(std::string_view place)>;

  /// The error names the line and what is wrong there.
  static Result<ScriptedInput> parse(std::string_view text);

  /// Appends a command given as a line of the script.
  Status add(std::string_view line);
  bool done() const { return steps_.empty(); }
  /// The events of the next frame. A place that cannot be located for 200 frames ends the script
  /// with an error.
  Result<std::vector<InputEvent>> next(const Locate& locate);

 private:
  struct Step {
    std::vector<InputEvent> events;
    std::string place;         ///< place to move to first; empty: none
    bool offset_only = false;  ///< the move is (dx, dy) from the last place
    double dx = 0, dy = 0;
  };
  void add_key(Key key, uint8_t mods);

  std::deque<Step> steps_;
  Point at_;
  int waited_ = 0;
};

}  // namespace tumble
