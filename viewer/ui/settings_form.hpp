#pragma once
#include "engine/world/settings.hpp"
#include "viewer/ui/panel.hpp"

#include <functional>
#include <optional>

namespace tumble {

/// A widget for each setting of a world; of the steppers only the one in use shows its own. True
/// when one was changed. Widgets are marked "PREFIX.NAME".
bool draw_settings_form(PanelContext& context, const char* prefix, WorldSettings& settings);

/// A slider for each number that the scene declares, marked "PREFIX.NAME". Gives the one that was
/// let go at another value.
std::optional<ChangeParameter> draw_numbers_form(
    PanelContext& context, const char* prefix,
    const std::function<double(const SceneParameter&)>& value_of);

/// True when another number was chosen; 0 stands for one per core.
bool draw_threads_slider(PanelContext& context, const char* name, int& threads);

/// A label at the left; the widget that follows takes the rest of the line.
void left_label(const char* text);

}  // namespace tumble
