#include "viewer/app/commands/simulate_export.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/options.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

/// round(seconds * fps), without frames after the last tick.
uint64_t frames_within(uint64_t ticks, Fraction fps, TickRate rate) {
  constexpr uint64_t most = 10'000'000;
  const Fraction seconds{int64_t(std::min(ticks, uint64_t{1} << 40)) * rate.den, rate.num};
  uint64_t frames = std::clamp<uint64_t>(frame_count(seconds, fps), 1, most);
  while (frames > 1 && frame_time(frames - 1, fps, rate).last_tick() > ticks) --frames;
  return frames;
}

/// Parses the edge of the cells [m]; 0: chosen automatically.
Result<double> cell_of(const std::string& text) {
  if (text == "auto") return 0.0;
  const auto cell = parse_fraction(text, "--surface");
  if (!cell) return cell.error();
  return cell->value();
}

}  // namespace

std::pair<Option, Option> declare_export(Options& options, ExportLine& line) {
  const Option folder =
      options
          .value("--export", line.folder,
                 "folder for the particles, a file for each system and frame, e.g. "
                 "water_000000.ply, and particles.json")
          .not_empty();
  options
      .value("--format", line.format,
             "of these files: ply (binary), or vtu (VTK XML, with a .pvd for each system)")
      .one_of(particle_formats())
      .shows_default()
      .needs(folder);
  const Option states =
      options
          .value("--states", line.states,
                 "folder for the states that `tumble render --states` draws frames from without "
                 "simulating, and states.json")
          .not_empty();
  options
      .value("--fps", line.fps,
             "frames of particles, or that states are for, per simulated second: 30, 23.976 or "
             "30000/1001")
      .shows_default();
  options
      .flag("--surface{auto}", line.surface,
            "also a mesh of the skin about the particles of each system, e.g. "
            "water-surface_000000.ply; =METRES: size of its cells, else half the mean radius")
      .needs(folder);
  options.flag("--resume", line.resume,
               "go on with the particles or states of an interrupted run; with the last state, "
               "where nothing else is wanted of the run before it");
  options.flag("--force", line.force, "overwrite particles, states and a replay");
  return {folder, states};
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

Result<StateExportOptions> state_options(const ExportLine& line, const SceneRequest& request,
                                         const LoadedScene& scene, const std::string& start,
                                         const std::string& replay, uint64_t ticks) {
  StateExportOptions out;
  if (line.folder.empty() && line.states.empty() && line.resume)
    return Error{ErrorCode::invalid_argument,
                 "--resume: there is nothing to go on with",
                 {},
                 "give --export or --states"};
  if (line.states.empty()) return out;
  const auto fps = parse_fraction(line.fps, "--fps");
  if (!fps) return fps.error();
  out.folder = line.states;
  out.list.version = TUMBLE_VERSION;
  out.list.scene = request.scene;
  out.list.start = start;
  out.list.run = replay;
  out.list.stepper = request.stepper;
  out.list.overrides = request.overrides;
  out.list.fps = *fps;
  out.list.rate = scene.built.world->settings().tick;
  out.list.frames_wanted = frames_within(ticks, *fps, out.list.rate);
  const SceneDescription& description = *scene.built.description;
  out.list.every_tick = description.look.trail > 0 ||
                        std::ranges::any_of(description.particles.items, [](const auto& system) {
                          return system.value.look.trail > 0;
                        });
  out.last_tick = ticks;
  out.geometry = !replay.empty();
  out.resume = line.resume;
  out.force = line.force;
  return out;
}

}  // namespace tumble
