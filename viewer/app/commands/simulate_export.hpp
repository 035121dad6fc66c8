#pragma once
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/simulate/particle_export.hpp"

namespace tumble {

/// The options of `tumble simulate` that export particles, as given.
struct ExportLine {
  std::string folder, format = "ply", fps = "30", surface;
  bool resume = false, force = false;
};

/// Declares them; gives --export, on which the others depend.
Option declare_export(Options& options, ExportLine& line);

/// What they ask of a run of so many ticks: round(seconds * fps) frames, at least the first one.
/// Error `invalid_argument` for a bad rate.
Result<ParticleExportOptions> export_options(const ExportLine& line, const SceneRequest& request,
                                             const LoadedScene& scene, uint64_t ticks);

}  // namespace tumble
