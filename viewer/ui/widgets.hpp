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
                 std::string_view tooltip, std::string_view shortcut);
void tooltip_with_key(PanelContext& context, std::string_view text, std::string_view shortcut);

/// Title, shortcut and close button of a panel; true when it was closed.
bool panel_heading(PanelContext& context, const PanelEntry& panel);
/// A small title within a panel.
void section(PanelContext& context, const char* title);
/// "label          value", the value in figures of equal width at the right edge.
void value_row(std::string_view label, std::string_view value, uint32_t colour = 0);
/// A switch: round knob that slides; true when it changed.
bool toggle(PanelContext& context, std::string_view name, const char* label, bool& on,
            std::string_view hint = {});
/// Text in the dim colour, wrapped.
void note(std::string_view text);
void small_text(PanelContext& context, std::string_view text, uint32_t colour);

/// "12.3 ms", "850 us".
std::string duration_text(double seconds);
/// Four figures and a unit with its SI prefix: "1.250 kJ".
std::string quantity_text(double value, std::string_view unit);
std::string vector_text(const Vec3& v, int decimals = 2);

/// A curve of a plot.
struct Curve {
  std::string_view label;
  uint32_t colour = 0;
  std::vector<float> values;  ///< oldest first, at equal steps
};
/// Curves in one frame with a shared scale and faint lines at round values.
void plot(PanelContext& context, std::string_view name, std::span<const Curve> curves, float height,
          std::string_view unit);

}  // namespace tumble
