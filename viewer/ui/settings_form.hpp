#pragma once
#include "engine/world/settings.hpp"
#include "viewer/ui/panel.hpp"

#include <functional>
#include <optional>

namespace tumble {

/// Draws a widget for each setting of a world; of the steppers, only the one in use shows its
/// settings. True if a setting was changed. Widgets are named "PREFIX.NAME".
bool draw_settings_form(PanelContext& context, const char* prefix, WorldSettings& settings);

/// Draws a slider for each number that the scene declares, named "PREFIX.NAME". Returns the one
/// that was released at another value.
std::optional<ChangeParameter> draw_numbers_form(
    PanelContext& context, const char* prefix,
    const std::function<double(const SceneParameter&)>& value_of);

/// A slider for the number of threads; true if it was changed. 0 stands for one thread per core.
bool draw_threads_slider(PanelContext& context, const char* name, int& threads);

/// A label at the left; the next widget fills the rest of the line.
void left_label(const char* text);

}  // namespace tumble
