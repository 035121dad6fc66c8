#pragma once
#include "viewer/ui/panel.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

// Building blocks of panels. Each records its position under a given name for scripts.

enum class Icon : uint8_t { play, pause, step_forward, step_back, restart, close, search, record };

/// A square button with an icon; the tooltip tells its action and key.
bool icon_button(PanelContext& context, std::string_view name, Icon icon, std::string_view tooltip,
                 std::string_view shortcut, float size = 30, bool lit = false);
/// A word in the bar that is lit while the panel it names is shown.
bool word_button(PanelContext& context, std::string_view name, const char* text, bool lit,
                 std::string_view tooltip, std::string_view shortcut, float height = 30);
void tooltip_with_key(PanelContext& context, std::string_view text, std::string_view shortcut);

/// Title, shortcut and close button of a panel; true when it was closed.
bool panel_heading(PanelContext& context, const PanelEntry& panel);
/// A small title within a panel.
void section(PanelContext& context, const char* title);
/// "label          value", with the value in tabular digits at the right edge.
void value_row(std::string_view label, std::string_view value, uint32_t colour = 0);
/// The same for three numbers in fixed columns, so that none moves when another gets a sign.
void vector_row(std::string_view label, const Vec3& v, int decimals);
/// A sliding switch; true if it was changed.
bool toggle(PanelContext& context, std::string_view name, const char* label, bool& on,
            std::string_view hint = {});
/// Text broken into as many lines as needed for the available width.
void wrapped(std::string_view text, uint32_t colour);
/// Such text in a dim colour.
void note(std::string_view text);
void small_text(PanelContext& context, std::string_view text, uint32_t colour);

/// The text, cut to `width` in the present font and ended by an ellipsis if it does not fit.
std::string shortened(std::string_view text, float width);
/// The text with line breaks in place of those spaces after which the next word does not fit.
std::string in_lines(std::string_view text, float width);
/// "12.3 ms", "850 us".
std::string duration_text(double seconds);
/// Four digits and a unit with SI prefix: "1.250 kJ".
std::string quantity_text(double value, std::string_view unit);
/// A round value without trailing zeros: "5 kJ", "-2.5 mm".
std::string round_text(double value, std::string_view unit);
std::string vector_text(const Vec3& v, int decimals = 2);

/// A curve of a plot.
struct Curve {
  std::string_view label;
  uint32_t colour = 0;
  std::vector<float> values;  ///< oldest first
};
/// Plots curves over `at` (ascending, one per value) in one frame with a common scale. The scale
/// ends at round values, with faint lines there; a legend is beside the curves.
void plot(PanelContext& context, std::string_view name, std::span<const double> at,
          std::span<const Curve> curves, float height, std::string_view unit);

}  // namespace tumble
