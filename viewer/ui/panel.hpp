#pragma once
#include "viewer/ui/ui_host.hpp"
#include "viewer/ui/ui_state.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace tumble {

/// Everything that a panel has access to: it reads the model, keeps its own state in `state`, and
/// requests all other changes from the application.
struct PanelContext {
  UiHost& host;
  const UiModel& model;
  UiState& state;
  std::vector<UiRequest>& requests;
  double dt = 0;

  template <class Request>
  void ask(Request request) const {
    requests.emplace_back(std::move(request));
  }
};

/// Edge of the picture at which a panel is docked; centred ones cover the scene and dim it.
enum class Dock : uint8_t { left, right, centre };

/// One panel. To add one: its file in panels/, a PanelId, a line in all_panels().
struct PanelEntry {
  PanelId id;
  std::string_view name;   ///< prefix of the names of its widgets in scripts
  std::string_view title;  ///< title shown to people
  Dock dock;
  std::optional<Action> toggle;
  float usual_height;  ///< [UI units] before its contents have been measured
  void (*draw)(PanelContext&);
  /// Drawn at the panel's lower edge, while the contents above it scroll; null: nothing.
  void (*footer)(PanelContext&) = nullptr;
};
std::span<const PanelEntry> all_panels();

// panels/*.cpp
void draw_assertions_panel(PanelContext&);
void draw_bookmarks_panel(PanelContext&);
void draw_build_panel(PanelContext&);
void draw_compare_panel(PanelContext&);
void draw_contact_panel(PanelContext&);
void draw_description_panel(PanelContext&);
void draw_drawing_panel(PanelContext&);
void draw_energy_panel(PanelContext&);
void draw_events_panel(PanelContext&);
void draw_help_panel(PanelContext&);
void draw_inspector_panel(PanelContext&);
void draw_lesson_panel(PanelContext&);
void draw_lesson_footer(PanelContext&);
void draw_measure_panel(PanelContext&);
void draw_microscope_panel(PanelContext&);
void draw_parts_panel(PanelContext&);
void draw_question_panel(PanelContext&);
void draw_ruler_panel(PanelContext&);
void draw_save_panel(PanelContext&);
void draw_scenes_panel(PanelContext&);
void draw_settings_panel(PanelContext&);
void draw_statistics_panel(PanelContext&);

/// Draws only the plot of the measure panel, over a picture of that size.
void draw_plot_page(PanelContext&, float width, float height);

/// Fixed parts of the interface that are not panels: panels/top_bar.cpp, panels/legend.cpp,
/// panels/timeline.cpp, panels/toasts.cpp.
void draw_top_bar(PanelContext&, const UiRect& rect);
void draw_legend(PanelContext&, const UiRect& free_area);
void draw_toasts(PanelContext&, const UiRect& free_area);
/// Draws, while the simulation is paused, the time line at the lower edge. Returns what remains of
/// the area.
UiRect draw_timeline(PanelContext&, const UiRect& free_area);

}  // namespace tumble
