#pragma once
#include "viewer/ui/panel.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

// Pieces that panels are made of. Each marks itself under the name it is given, so that scripts
// find it.

enum class Icon : uint8_t { play, pause, step_forward, step_back, restart, close, search, record };

/// A square button with a drawn sign; the tooltip says what it does and its key.
bool icon_button(PanelContext& context, std::string_view name, Icon icon, std::string_view tooltip,
                 std::string_view shortcut, float size = 30, bool lit = false);
/// A word in the bar that is lit while what it names is shown.
bool word_button(PanelContext& context, std::string_view name, const char* text, bool lit,
                 std::string_view tooltip, std::string_view shortcut, float height = 30);
void tooltip_with_key(PanelContext& context, std::string_view text, std::string_view shortcut);

/// Title, shortcut and close button of a panel; true when it was closed.
bool panel_heading(PanelContext& context, const PanelEntry& panel);
/// A small title within a panel.
void section(PanelContext& context, const char* title);
/// "label          value", the value in figures of equal width at the right edge.
void value_row(std::string_view label, std::string_view value, uint32_t colour = 0);
/// The same of three numbers, each with a place of its own: none moves when another gets a sign.
void vector_row(std::string_view label, const Vec3& v, int decimals);
/// A switch: round knob that slides; true when it changed.
bool toggle(PanelContext& context, std::string_view name, const char* label, bool& on,
            std::string_view hint = {});
/// Text over as many lines as it needs in the room that there is.
void wrapped(std::string_view text, uint32_t colour);
/// The same in the dim colour.
void note(std::string_view text);
void small_text(PanelContext& context, std::string_view text, uint32_t colour);

/// The text, or as much of its beginning as fits into `width` with an ellipsis, in the font of now.
std::string shortened(std::string_view text, float width);
/// The text with a new line in place of each space behind which the next word has no room.
std::string in_lines(std::string_view text, float width);
/// "12.3 ms", "850 us".
std::string duration_text(double seconds);
/// Four figures and a unit with its SI prefix: "1.250 kJ".
std::string quantity_text(double value, std::string_view unit);
/// A round value without the zeros behind it: "5 kJ", "-2.5 mm".
std::string round_text(double value, std::string_view unit);
std::string vector_text(const Vec3& v, int decimals = 2);

/// A curve of a plot.
struct Curve {
  std::string_view label;
  uint32_t colour = 0;
  std::vector<float> values;  ///< oldest first
};
/// Curves over `at` (ascending, one for each value) in one frame with a shared scale that ends at
/// round values, faint lines there, and what they stand for beside the curves.
void plot(PanelContext& context, std::string_view name, std::span<const double> at,
          std::span<const Curve> curves, float height, std::string_view unit);

}  // namespace tumble
