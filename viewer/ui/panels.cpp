#include "viewer/ui/panel.hpp"

namespace tumble {
namespace {

constexpr PanelEntry entries[] = {
    {PanelId::statistics, "statistics", "Statistics", Dock::left, Action::toggle_statistics, 400,
     draw_statistics_panel},
    {PanelId::energy, "energy", "Energy", Dock::left, Action::toggle_energy, 470,
     draw_energy_panel},
    {PanelId::drawing, "drawing", "Show", Dock::right, std::nullopt, 262, draw_drawing_panel},
    {PanelId::inspector, "inspector", "Body", Dock::right, std::nullopt, 110, draw_inspector_panel},
    {PanelId::settings, "settings", "Settings", Dock::right, std::nullopt, 560,
     draw_settings_panel},
    {PanelId::help, "help", "Keys and mouse", Dock::centre, Action::toggle_help, 560,
     draw_help_panel},
    {PanelId::scenes, "scenes", "Open a scene", Dock::centre, Action::pick_scene, 420,
     draw_scenes_panel},
    {PanelId::microscope, "microscope", "Microscope", Dock::left, Action::toggle_microscope, 520,
     draw_microscope_panel},
    {PanelId::contact, "contact", "Contact", Dock::left, std::nullopt, 470, draw_contact_panel},
    {PanelId::build, "build", "Build", Dock::left, Action::toggle_build, 470, draw_build_panel},
    {PanelId::save, "save", "Save the scene", Dock::centre, Action::save_scene, 300,
     draw_save_panel},
    {PanelId::measure, "measure", "Plot", Dock::left, Action::toggle_measure, 300,
     draw_measure_panel},
    {PanelId::compare, "compare", "Compare", Dock::left, Action::toggle_compare, 300,
     draw_compare_panel},
    {PanelId::question, "question", "Question", Dock::centre, std::nullopt, 160,
     draw_question_panel},
    {PanelId::assertions, "assertions", "Assertions", Dock::right, Action::toggle_assertions, 110,
     draw_assertions_panel},
    {PanelId::events, "events", "Events", Dock::left, Action::toggle_events, 340,
     draw_events_panel},
    {PanelId::lesson, "lesson", "Lesson", Dock::left, Action::toggle_lesson, 420, draw_lesson_panel,
     draw_lesson_footer},
    {PanelId::parts, "parts", "Sources, forces, sensors", Dock::right, Action::toggle_parts, 300,
     draw_parts_panel},
    {PanelId::bookmarks, "bookmarks", "Time", Dock::left, Action::toggle_bookmarks, 330,
     draw_bookmarks_panel},
    {PanelId::ruler, "ruler", "Ruler", Dock::left, Action::toggle_ruler, 160, draw_ruler_panel},
    {PanelId::description, "description", "Scene", Dock::right, Action::toggle_description, 420,
     draw_description_panel},
};
static_assert(std::size(entries) == panel_count);

}  // namespace

std::span<const PanelEntry> all_panels() {
  return entries;
}

}  // namespace tumble
