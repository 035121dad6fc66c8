#include "viewer/ui/panel.hpp"

namespace tumble {
namespace {

constexpr PanelEntry entries[] = {
    {PanelId::drawing, "drawing", "Show", Dock::left, std::nullopt, 260, draw_drawing_panel},
    {PanelId::settings, "settings", "Settings", Dock::left, std::nullopt, 430, draw_settings_panel},
    {PanelId::inspector, "inspector", "Body", Dock::right, std::nullopt, 360, draw_inspector_panel},
    {PanelId::statistics, "statistics", "Statistics", Dock::right, Action::toggle_statistics, 330,
     draw_statistics_panel},
    {PanelId::energy, "energy", "Energy", Dock::right, Action::toggle_energy, 200,
     draw_energy_panel},
    {PanelId::help, "help", "Keys and mouse", Dock::centre, Action::toggle_help, 560,
     draw_help_panel},
    {PanelId::scenes, "scenes", "Open a scene", Dock::centre, Action::pick_scene, 420,
     draw_scenes_panel},
};
static_assert(std::size(entries) == panel_count);

}  // namespace

std::span<const PanelEntry> all_panels() {
  return entries;
}

}  // namespace tumble
