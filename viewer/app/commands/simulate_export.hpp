#pragma once
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/simulate/particle_export.hpp"
#include "viewer/app/simulate/state_export.hpp"

namespace tumble {

/// The options of `tumble simulate` for saving particles and states, as typed.
struct ExportLine {
  std::string folder, states, format = "ply", fps = "30", surface;
  bool resume = false, force = false;
};

/// Declares the options; returns --export and --states, on which the others depend.
std::pair<Option, Option> declare_export(Options& options, ExportLine& line);

/// The options for a run of `ticks` ticks: round(seconds * fps) frames, but at least the first.
/// Error `invalid_argument` for an invalid rate.
Result<ParticleExportOptions> export_options(const ExportLine& line, const SceneRequest& request,
                                             const LoadedScene& scene, uint64_t ticks);

/// The same for states. `replay` tells that commands outside of the scene change the world.
Result<StateExportOptions> state_options(const ExportLine& line, const SceneRequest& request,
                                         const LoadedScene& scene, const std::string& start,
                                         const std::string& replay, uint64_t ticks);

}  // namespace tumble
