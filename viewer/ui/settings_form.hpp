#pragma once
#include "engine/world/settings.hpp"
#include "viewer/ui/panel.hpp"

namespace tumble {

/// A widget for each setting of a world; of the steppers only the one in use shows its own. True
/// when one was changed. Widgets are marked "PREFIX.NAME".
bool draw_settings_form(PanelContext& context, const char* prefix, WorldSettings& settings);

}  // namespace tumble
