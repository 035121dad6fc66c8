#pragma once
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/simulate/particle_export.hpp"
#include "viewer/app/simulate/state_export.hpp"

namespace tumble {

/// The options of `tumble simulate` that save particles and states, as given.
struct ExportLine {
  std::string folder, states, format = "ply", fps = "30", surface;
  bool resume = false, force = false;
};

/// Declares them; gives --export and --states, on which the others depend.
std::pair<Option, Option> declare_export(Options& options, ExportLine& line);

/// What they ask of a run of so many ticks: round(seconds * fps) frames, at least the first one.
/// Error `invalid_argument` for a bad rate, and for one folder for particles and states.
Result<ParticleExportOptions> export_options(const ExportLine& line, const SceneRequest& request,
                                             const LoadedScene& scene, uint64_t ticks);

/// Likewise of states; `replay`: something is done to the world that the scene does not tell of.
Result<StateExportOptions> state_options(const ExportLine& line, const SceneRequest& request,
                                         const LoadedScene& scene, const std::string& start,
                                         const std::string& replay, uint64_t ticks);

}  // namespace tumble
