#include "engine/core/hash.hpp"
#include "engine/scene/pack/pack.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/command.hpp"
#include "viewer/app/commands/file_roles.hpp"
#include "viewer/app/drawing.hpp"
#include "viewer/app/large_blocks.hpp"
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/scenes/saved_states.hpp"
#include "viewer/app/scenes/scene_files.hpp"
#include "viewer/app/scenes/scene_look.hpp"
#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/folder_lock.hpp"
#include "viewer/capture/progress.hpp"
#include "viewer/capture/sequence.hpp"
#include "viewer/capture/video_pipe.hpp"

#include <algorithm>
#include <future>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

struct RenderLine {
  SceneRequest request;
  std::string folder, states, video, fps, size = "1280x720", seconds, camera, context = "auto",
                                          overlay, quality = "standard";
  std::optional<uint64_t> frames;
  bool resume = false, force = false, json = false, quiet = false;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

Error usage(std::string message, std::string cure = {}) {
  return {ErrorCode::invalid_argument, std::move(message), {}, std::move(cure)};
}

constexpr uint64_t most_frames = 10'000'000;

Error no_frames() {
  return usage("how many frames?", "give --frames N or --seconds S");
}

/// Number of frames up to the end of a replay.
uint64_t frames_of_replay(const ReplayPlayer& player, const FramesFile& plan) {
  return std::min(frames_until(player.last_tick(), plan.fps, plan.rate), most_frames);
}

/// Whether the run may have a replay, which would determine the number of frames.
bool may_play(const RenderLine& line) {
  const ReplayRequest& wanted = line.request.replay;
  return !wanted.none && (!wanted.file.empty() || is_pack_file(line.request.scene));
}

/// Determines rate, size and number of frames (still unknown if a replay may determine it). For
/// saved states, the default is all frames that can be drawn from them.
Status parse_plan(const RenderLine& line, const SavedStates* states, FramesFile& plan) {
  if (!line.fps.empty()) {
    const auto fps = parse_fraction(line.fps, "--fps");
    if (!fps) return fps.error();
    plan.fps = *fps;
  } else if (states) {
    plan.fps = states->list().fps;
  }
  if (auto size = parse_picture_size(line.size, plan.width, plan.height); !size) return size;
  const bool by_seconds = !line.seconds.empty();
  if (line.frames && by_seconds)
    return usage("--frames and --seconds both say how many frames", "give one of the two");
  if (line.frames) {
    plan.frames_wanted = *line.frames;
  } else if (!by_seconds) {
    if (!states && may_play(line)) return {};
    if (!states) return no_frames();
    plan.frames_wanted = states->frames_at(plan.fps);
  } else {
    const auto seconds = parse_fraction(line.seconds, "--seconds", true);
    if (!seconds) return seconds.error();
    plan.frames_wanted = frame_count(*seconds, plan.fps);
  }
  if (plan.frames_wanted == 0 || plan.frames_wanted > most_frames)
    return usage(fmt::format("{} frames: it must be 1 to {}", plan.frames_wanted, most_frames));
  return {};
}

/// Key of everything that must be equal for a resumed run to continue this one.
std::string run_key(const RenderLine& line, const LoadedScene& scene, const ReplayPlayer* player,
                    const SavedStates* states, const FramesFile& plan) {
  std::string text =
      fmt::format("{}|{:016x}|{}/{}|{}x{}|{}|{}|{}|{}", scene.name, scene.built.world->state_hash(),
                  plan.fps.num, plan.fps.den, plan.width, plan.height, plan.camera_name,
                  line.overlay, line.request.stepper, TUMBLE_VERSION);
  const ViewDescription& look = scene.built.description->look;
  for (const std::string& overlay : look.overlays) text += "|overlay " + overlay;
  if (look.trail > 0) text += fmt::format("|trail {}", look.trail);
  if (line.quality != "standard") text += "|quality " + line.quality;
  if (states) text += "|states " + states->list().run;
  if (player) text += fmt::format("|replay {} {}", player->last_tick(), player->last_hash());
  for (const std::string& change : line.request.overrides) text += "|" + change;
  return hash_text(hash_bytes(text.data(), text.size()));
}

void print_result(const RenderLine& line, const FramesFile& plan) {
  const SequenceTimes& t = plan.times;
  const double n = t.frames > 0 ? double(t.frames) : 1;
  const std::string video = line.folder.empty() ? "" : ffmpeg_line(line.folder, plan.fps);
  if (line.json) {
    const nlohmann::ordered_json out = {{"folder", line.folder},
                                        {"frames", plan.frames.size()},
                                        {"rendered", t.frames},
                                        {"complete", plan.frames.size() >= plan.frames_wanted},
                                        {"context", plan.context},
                                        {"renderer", plan.renderer},
                                        {"total_seconds", t.total},
                                        {"first_frame_seconds", t.first_frame},
                                        {"ms_per_frame",
                                         {{"simulate", 1e3 * t.simulate / n},
                                          {"extract", 1e3 * t.extract / n},
                                          {"draw", 1e3 * t.draw / n},
                                          {"read_back", 1e3 * t.read_back / n},
                                          {"wait_for_encoder", 1e3 * t.wait / n},
                                          {"encode_beside", 1e3 * t.encode / n}}},
                                        {"ffmpeg", video},
                                        {"video", line.video}};
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  }
  if (line.quiet) return;
  fmt::print(stderr,
             "{} frame{} in {:.2f} s ({:.1f} frames/s), the first on disk after {:.2f} s\n"
             "ms per frame: simulate {:.1f}, extract {:.1f}, draw {:.1f}, read back {:.1f}, wait "
             "for encoder {:.1f}; beside it encode {:.1f}\n",
             t.frames, t.frames == 1 ? "" : "s", t.total, t.total > 0 ? n / t.total : 0,
             t.first_frame, 1e3 * t.simulate / n, 1e3 * t.extract / n, 1e3 * t.draw / n,
             1e3 * t.read_back / n, 1e3 * t.wait / n, 1e3 * t.encode / n);
  if (!line.video.empty())
    fmt::print(stderr, "a video of them is {}\n", line.video);
  else
    fmt::print(stderr, "a video of them: {}\n", video);
}

int code_of(const SequenceResult& result, const StopSignal& stop) {
  switch (result.end) {
    case SequenceEnd::complete:
      return exit_ok;
    case SequenceEnd::stopped:
      return stop.exit_code();
    case SequenceEnd::cannot_write:
      return report(result.error, exit_cannot_write);
    case SequenceEnd::cannot_draw:
      return report(result.error, exit_no_renderer);
    case SequenceEnd::cannot_read:
      return report(result.error, exit_bad_input);
    case SequenceEnd::broken_down:
      return report(result.error, exit_broken_down);
    case SequenceEnd::diverged:
      return report(result.error, exit_negative);
  }
  return exit_broken_down;
}

using NextFrame = Result<std::shared_ptr<const Frame>>;

/// Steps the world by a tick, then applies what the replay does after it.
NextFrame simulate_tick(World& world, ReplayPlayer* player) {
  if (const auto stepped = world.step(); !stepped) return stepped.error();
  if (player)
    if (const Status done = player->follow(world); !done) return done.error();
  return world.frame();
}

/// Whether a picture depends on all ticks before it (trails), or only on the last one.
bool made_of_every_tick(const SceneDescription& scene, const Overlays& shown) {
  const bool arrows_of_particles = !scene.particles.empty() && (shown.velocities || shown.momenta);
  const bool paths = std::ranges::any_of(
      scene.particles.items, [](const auto& system) { return system.value.look.trail > 0; });
  return paths || scene.look.trail > 0 || shown.total_forces || arrows_of_particles;
}

/// Reads the first state; the error says why the planned frames cannot be drawn from the states.
NextFrame begin_with(const SavedStates& states, const LoadedScene& scene, const Overlays& shown,
                     const FramesFile& plan) {
  if (scene.built.microscope)
    return usage("the microscope looks at a world that simulates, not at saved states",
                 "render without --states");
  const bool each = made_of_every_tick(*scene.built.description, shown);
  if (Status there = states.check_frames(plan.frames_wanted, plan.fps, each); !there)
    return there.error();
  return states.begin(*scene.built.world);
}

/// Renders the frames, once everything is loaded.
int render_frames(const RenderLine& line, const LoadedScene& scene, ReplayPlayer* player,
                  const SavedStates* states, const ViewPoint& view, Drawing& drawing,
                  FramesFile& plan, SequenceOptions& options, const StopSignal& stop) {
  const ContextInfo& info = drawing.context->info();
  plan.context = info.name;
  plan.renderer = info.renderer;
  plan.gl_version = info.version;

  const SceneDescription& description = *scene.built.description;
  World& world = *scene.built.world;
  if (line.overlay.empty()) options.extract.overlays = overlays_of(description);
  const auto start = states ? begin_with(*states, scene, options.extract.overlays, plan)
                            : NextFrame(world.frame());
  if (!start)
    return report(start.error(),
                  start.error().code == ErrorCode::invalid_argument ? exit_usage : exit_bad_input);
  SequenceScene sequence{world, *start, *drawing.renderer, {}, {}, {}};
  const bool each = made_of_every_tick(description, options.extract.overlays);
  sequence.advance = [player, states, each](World& w, uint64_t tick) {
    return states ? states->advance(w, tick, each) : simulate_tick(w, player);
  };
  if (const auto quality = parse_quality(line.quality); quality.ok())
    sequence.look.quality = *quality;
  apply_look(description, sequence.look);
  options.trail_seconds = description.look.trail;
  options.extract.notes = body_notes(scene.built);
  options.extract.microscope = scene.built.microscope;
  options.extract.world_hierarchy = scene.built.world->settings().hierarchy;
  sequence.camera = [&view](const Frame& from, const Frame& to, double s) {
    return view.at(from, to, s);
  };
  Progress progress(plan.frames_wanted, plan.frames.size());
  if (!line.quiet)
    options.progress = [&progress, then = options.progress](uint64_t done) {
      progress.show(done);
      if (then) then(done);
    };
  const SequenceResult result = run_sequence(sequence, plan, options, stop);
  progress.finish();
  if (result.end == SequenceEnd::complete || result.end == SequenceEnd::stopped)
    print_result(line, plan);
  if (player && result.end == SequenceEnd::complete)
    if (const Status same = player->verdict(); !same) return report(same.error(), exit_negative);
  return code_of(result, stop);
}

/// Checks where the pictures are to be written.
Status check_outputs(const RenderLine& line) {
  if (line.folder.empty() && line.video.empty())
    return usage("where to?", "give -o DIR for pictures, or --video FILE.mp4");
  if (line.video.empty()) return {};
  if (line.resume) return usage("a video cannot be resumed", "leave out --resume");
  std::error_code none;
  if (!line.force && std::filesystem::exists(line.video, none))
    return Error{ErrorCode::io, "the video is there already", line.video,
                 "--force overwrites it, or name another"};
  if (find_program("ffmpeg").empty())
    return Error{ErrorCode::io, "no video can be made: the program ffmpeg is not installed",
                 line.video,
                 "install it (apt install ffmpeg), or leave --video away: -o DIR writes pictures"};
  return {};
}

int run_render(RenderLine& line) {
  FramesFile plan;
  const FileRoles files =
      FileRoles().reads(line.request).writes("-o", line.folder).writes("--video", line.video);
  if (const Status apart = files.apart(); !apart) return report(apart.error(), exit_usage);
  if (const Status known = check_context_name(line.context); !known)
    return report(known.error(), exit_usage);
  if (auto good = check_outputs(line); !good)
    return report(good.error(),
                  good.error().code == ErrorCode::io ? exit_cannot_write : exit_usage);
  std::optional<SavedStates> states;
  if (!line.states.empty()) {
    auto opened = SavedStates::open(line.states);
    if (!opened) return report(opened.error(), exit_bad_input);
    states = *std::move(opened);
  }
  SavedStates* saved = states ? &*states : nullptr;
  if (auto parsed = parse_plan(line, saved, plan); !parsed)
    return report(parsed.error(), exit_usage);
  SequenceOptions options;
  options.folder = line.folder;
  options.video = line.video;
  options.resume = line.resume;
  options.force = line.force;
  if (const auto overlays = parse_overlays(line.overlay); !overlays)
    return report(overlays.error(), exit_usage);
  else
    options.extract.overlays = *overlays;
  if (auto quality = parse_quality(line.quality); !quality)
    return report(quality.error(), exit_usage);
  options.program_start = line.start;
  options.log = stderr_log(line.quiet ? LogLevel::warning : LogLevel::info);
  if (auto scene = find_scene(line.request.scene); !scene)
    return report(scene.error(), exit_bad_input);
  std::optional<Result<FolderLock>> lock;
  if (!line.folder.empty()) {
    if (auto made = make_folder(line.folder); !made) return report(made.error(), exit_cannot_write);
    lock.emplace(FolderLock::take(line.folder));
    if (!*lock) return report(lock->error(), exit_cannot_write);
  }
  std::vector<FrameRecord> kept;
  // Checked before anything is loaded: existing frames must not be overwritten.
  if (!line.resume)
    if (auto keep = frames_to_keep(options, plan, kept); !keep)
      return report(keep.error(), exit_cannot_write);

  const StopSignal stop;
  line.request.log = options.log;
  // The scene loads while the context is made, and the memory of the first picture; a resumed run
  // may need none.
  std::optional<BlocksAhead> blocks;
  const auto quality = parse_quality(line.quality);
  if (!line.resume && quality) blocks.emplace(blocks_of_picture(plan.width, plan.height, *quality));
  auto loading = std::async(std::launch::async, [&line, &stop, saved] {
    const Stoppable scope(&stop.flag());
    return saved ? saved->load_scene(line.request, TUMBLE_VERSION)
                 : load_scene_and_world(line.request);
  });
  std::optional<Result<Drawing>> drawing;
  if (!line.resume) drawing.emplace(make_drawing(line.context, options.log));
  if (drawing && !(drawing->ok() && (*drawing)->context->info().software)) blocks.reset();
  // What the first picture had no use for is not kept.
  options.progress = [&blocks](uint64_t) { blocks.reset(); };
  const auto scene = loading.get();
  if (stop.requested()) return stop.exit_code();
  if (!scene) return report(scene.error(), exit_code_of_scene(scene.error()));
  const auto player = saved ? Result<std::shared_ptr<ReplayPlayer>>(std::shared_ptr<ReplayPlayer>())
                            : replay_of(line.request, *scene);
  if (!player) return report(player.error(), exit_code_of_scene(player.error()));
  plan.rate = scene->built.world->settings().tick;
  if (*player && !line.quiet)
    fmt::print(stderr, "{}\n", replay_words(line.request, *scene, **player));
  if (plan.frames_wanted == 0) {
    if (!*player) return report(no_frames(), exit_usage);
    plan.frames_wanted = frames_of_replay(**player, plan);
  }
  const auto view = find_view_point(scene->built, line.camera, double(plan.width) / plan.height);
  if (!view) return report(view.error(), exit_usage);

  plan.version = TUMBLE_VERSION;
  plan.scene = line.request.scene;
  plan.camera_name = view->name;
  plan.camera = view->camera;
  plan.run = run_key(line, *scene, player->get(), saved, plan);
  if (line.resume) {
    if (auto keep = frames_to_keep(options, plan, kept); !keep)
      return report(keep.error(), exit_cannot_write);
    plan.frames = kept;
    if (kept.size() >= plan.frames_wanted) {
      fmt::print(stderr, "all {} frames are there already\n", plan.frames_wanted);
      if (line.json) print_result(line, plan);
      return exit_ok;
    }
    drawing.emplace(make_drawing(line.context, options.log));
  }
  if (!*drawing) return report(drawing->error(), exit_no_renderer);
  return render_frames(line, *scene, player->get(), saved, *view, **drawing, plan, options, stop);
}

std::string overlay_names() {
  std::string out;
  for (const OverlayEntry& o : all_overlays())
    out += (out.empty() ? "" : " ") + std::string(o.name);
  return out;
}

}  // namespace

CommandAction declare_render(Options& options) {
  auto line = std::make_shared<RenderLine>();
  options
      .value("scene", line->request.scene,
             "scene, robot or mesh file, or a name of `tumble scenes`")
      .required();
  options.value("-o,--output", line->folder, "folder for frame_000000.png ... and frames.json")
      .not_empty();
  options
      .value("--video", line->video,
             "a video by the program ffmpeg (.mp4, .webm, .gif ...), without -o only that")
      .not_empty();
  options.value("--frames", line->frames, "number of frames").natural();
  options.value("--seconds", line->seconds,
                "instead: simulated time; round(seconds * fps) frames; with a replay neither is "
                "needed");
  options.value("--fps", line->fps,
                "frames per simulated second: 30 (the default), 23.976 or 30000/1001");
  options.value("--size", line->size, "width x height in pixels").shows_default();
  options.value("--camera", line->camera, "a camera of the scene; the first one unless given");
  options.value("--context", line->context, "what draws: " + context_list()).shows_default();
  options.value("--threads", line->request.threads, "of the simulation; 0: one per core")
      .between(0, 1024);
  const Option stepper =
      options.value("--stepper", line->request.stepper, "instead of the scene's");
  options.value("--overlay", line->overlay,
                "instead of the scene's, comma-separated: none " + overlay_names());
  options
      .value("--quality", line->quality,
             "draft: no anti-aliasing, for a quick look; standard; high: finer shadows")
      .shows_default();
  options.value("--set", line->request.overrides, "path=value, e.g. bodies.ball.mass=3").one_each();
  const Option states = options.value(
      "--states", line->states,
      "folder of `tumble simulate --states`: drawn without simulating, by default all there is; "
      "--set changes looks, lights and cameras");
  states.not_empty().excludes(stepper);
  declare_replay(options, line->request.replay);
  options.flag("--resume", line->resume, "go on with the frames of an interrupted run");
  options.flag("--force", line->force, "overwrite frames that exist");
  options.flag("-q,--quiet", line->quiet, "no progress, only warnings and errors");
  options.flag("--json", line->json, "one JSON object on stdout");
  options.footer(
      "Frame 0 is the initial state, frame k the state at k/fps. Each file appears whole or not "
      "at\n"
      "all; Ctrl-C stops between two frames (130), and --resume goes on.\n\n"
      "Examples:\n"
      "  tumble render demolition -o out --seconds 4\n"
      "  tumble render my_scene.json -o out --frames 1 --size 1920x1080\n"
      "  tumble render demolition --video demolition.mp4 --seconds 4\n"
      "  tumble render tower -o out --seconds 2 --fps 60 --overlay contacts,forces\n"
      "  tumble render mesh_pile -o out --frames 1 --overlay hierarchy:obb:4\n"
      "  tumble simulate dam_break --seconds 2 --states run && tumble render dam_break --states "
      "run\n"
      "      -o out --camera top --set particles.water.look.style=surface\n"
      "  tumble render part.stl -o out --seconds 2       a mesh file falls on a table");
  return [line] { return run_render(*line); };
}

}  // namespace tumble
