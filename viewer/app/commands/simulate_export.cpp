#include "viewer/app/commands/simulate_export.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/options.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

/// round(seconds * fps), without those that the last tick does not reach.
uint64_t frames_within(uint64_t ticks, Fraction fps, TickRate rate) {
  constexpr uint64_t most = 10'000'000;
  const Fraction seconds{int64_t(std::min(ticks, uint64_t{1} << 40)) * rate.den, rate.num};
  uint64_t frames = std::clamp<uint64_t>(frame_count(seconds, fps), 1, most);
  while (frames > 1 && frame_time(frames - 1, fps, rate).last_tick() > ticks) --frames;
  return frames;
}

/// Edge of the cells [m]; 0: to be chosen.
Result<double> cell_of(const std::string& text) {
  if (text == "auto") return 0.0;
  const auto cell = parse_fraction(text, "--surface");
  if (!cell) return cell.error();
  return cell->value();
}

}  // namespace

Option declare_export(Options& options, ExportLine& line) {
  const Option folder = options.value(
      "--export", line.folder,
      "folder for the particles, a file for each system and frame, e.g. water_000000.ply, and "
      "particles.json");
  options
      .value("--format", line.format,
             "of these files: ply (binary), or vtu (VTK XML, with a .pvd for each system)")
      .one_of(particle_formats())
      .shows_default()
      .needs(folder);
  options.value("--fps", line.fps, "their frames per simulated second: 30, 23.976 or 30000/1001")
      .shows_default()
      .needs(folder);
  options
      .flag("--surface{auto}", line.surface,
            "also a mesh of the skin about the particles of each system, e.g. "
            "water-surface_000000.ply; =METRES: size of its cells, else half the mean radius")
      .needs(folder);
  options.flag("--resume", line.resume, "go on with the files of an interrupted export")
      .needs(folder);
  options.flag("--force", line.force, "overwrite files of an export, and a replay");
  return folder;
}

Result<ParticleExportOptions> export_options(const ExportLine& line, const SceneRequest& request,
                                             const LoadedScene& scene, uint64_t ticks) {
  const auto fps = parse_fraction(line.fps, "--fps");
  if (!fps) return fps.error();
  ParticleExportOptions out;
  out.folder = line.folder;
  out.format = line.format;
  out.fps = *fps;
  out.frames = frames_within(ticks, *fps, scene.built.world->settings().tick);
  if (!line.surface.empty()) {
    const auto cell = cell_of(line.surface);
    if (!cell) return cell.error();
    out.surface = *cell;
  }
  out.resume = line.resume;
  out.force = line.force;
  out.threads = request.threads;
  out.version = TUMBLE_VERSION;
  out.scene = request.scene;
  out.run = fmt::format("{}|{}", scene.name, request.stepper);
  for (const std::string& change : request.overrides) out.run += "|" + change;
  return out;
}

}  // namespace tumble
