#include "engine/scene/build/joint_rank.hpp"
#include "engine/scene/pack/pack.hpp"
#include "engine/world/replay.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/command.hpp"
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/lesson_check.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/scenes/scene_assertions.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

struct CheckLine {
  std::vector<std::string> files, overrides;
  std::optional<double> seconds;  ///< length of a run
  bool run = false;
  bool json = false;
};

nlohmann::ordered_json fault_json(const Fault& f) {
  nlohmann::ordered_json out = {{"file", f.file}};
  if (f.line > 0) out["line"] = f.line;
  if (!f.path.empty()) out["path"] = f.path;
  out["message"] = f.message;
  return out;
}

/// Start penetrations deeper than this are reported; the event stepper has to resolve them first.
constexpr double worth_saying = 1e-6;  // [m]

void report_overlaps(const World& world, std::vector<std::string>& warnings,
                     nlohmann::ordered_json& out) {
  const WorldSettings& settings = world.settings();
  if (settings.stepper != "event") return;
  const std::vector<Overlap> overlaps = world.overlaps(worth_saying);
  const auto frame = world.frame();
  out["overlaps"] = nlohmann::ordered_json::array();
  for (const Overlap& o : overlaps)
    out["overlaps"].push_back({{"a", frame->info(o.a.index).name},
                               {"b", frame->info(o.b.index).name},
                               {"depth_m", o.depth}});
  if (overlaps.empty()) return;
  const Overlap& worst = overlaps.front();
  warnings.push_back(fmt::format(
      "{} pair{} of bodies overlap{} at the start, '{}' and '{}' by {:.3g} mm; the event stepper "
      "works that off at {} m/s (settings.event.recovery_speed)",
      overlaps.size(), overlaps.size() == 1 ? "" : "s", overlaps.size() == 1 ? "s" : "",
      frame->info(worst.a.index).name, frame->info(worst.b.index).name, 1e3 * worst.depth,
      settings.event.recovery_speed));
}

/// Length of a run if no assertion names a time [s]: most of what swings, falls or settles has done
/// so by then.
constexpr double unsaid_run = 10;

/// Runs a scene until its assertions are decided, or for the time given on the command line. True
/// if all hold; an assertion whose time is not reached counts as not holding.
bool run_assertions(World& world, SceneAssertions& assertions, const std::optional<double>& seconds,
                    const std::string& file, nlohmann::ordered_json& out) {
  assertions.see(*world.frame());
  const SceneAssertions::Span span =
      seconds ? SceneAssertions::Span{*seconds, false} : assertions.span(unsaid_run);
  if (span.assumed)
    fmt::print(stderr,
               "{}: no assertion says when the run ends; it is run to {:g} s (--seconds changes "
               "that)\n",
               file, span.seconds);
  const double last = span.seconds - 0.5 * world.settings().tick.tick();
  Status stepped;
  while (stepped && world.time() < last) {
    const auto report = world.step();
    if (report)
      assertions.see(*world.frame());
    else
      stepped = report.error();
  }
  assertions.finish(*world.frame());
  const std::vector<AssertionView> views = assertions.views();
  const bool cut_short = stepped.ok() && any_waits(views);
  const bool holds = stepped.ok() && !any_fails(views) && !cut_short;
  if (!stepped) fmt::print(stderr, "{}: {}\n", file, stepped.error().text());
  fmt::print(stderr, "{}", verdict_text(views));
  if (cut_short)
    fmt::print(stderr,
               "{}: the run ended at {:g} s, before all assertions were decided, so they are not "
               "known to hold: leave --seconds out, or give it {} or more\n",
               file, world.time(), assertions.last_moment());
  out["ran_s"] = world.time();
  out["assertions"] = views.size();
  out["assertions_hold"] = holds;
  return holds;
}

/// Whether the world gives the lesson's answer to each question of a lesson.
bool run_lesson(const SceneRequest& request, const std::string& file, nlohmann::ordered_json& out) {
  const auto checks = check_lesson(request);
  if (!checks) {
    fmt::print(stderr, "{}: {}\n", file, checks.error().text());
    return false;
  }
  bool holds = true;
  out["lesson"] = nlohmann::ordered_json::array();
  for (const SceneLesson::Check& c : *checks) {
    nlohmann::ordered_json one = {{"page", c.step + 1}, {"ask", c.ask}, {"at", c.at}};
    if (c.answer) one["answer"] = *c.answer;
    if (c.measured) one["measured"] = *c.measured;
    one["tolerance"] = c.tolerance;
    one["holds"] = c.holds();
    out["lesson"].push_back(std::move(one));
    if (c.holds()) continue;
    holds = false;
    const auto number = [](const std::optional<double>& v) {
      return v ? fmt::format("{:.6g}", *v) : std::string("nothing");
    };
    fmt::print(
        stderr,
        "{}: page {} of the lesson, \"{}\": the answer is {} within {:g}, but the world says "
        "{} at {:g} s\n",
        file, c.step + 1, c.ask, number(c.answer), c.tolerance, number(c.measured), c.at);
  }
  return holds;
}

/// Plays the replay of a pack to its end. True if there is none, or if it ends in the recorded
/// state.
bool run_replay_of(const LoadedScene& scene, const std::string& file, nlohmann::ordered_json& out) {
  const auto bytes = read_file(scene.file.parent_path() / pack_replay_name);
  if (!bytes || !is_pack_file(file)) return true;
  const auto replayed = run_replay(std::as_bytes(std::span(*bytes)));
  const bool same = replayed && replayed->same;
  out["replay_holds"] = same;
  if (!replayed)
    fmt::print(stderr, "{}: replay: {}\n", file, replayed.error().text());
  else if (!same)
    fmt::print(stderr, "{}: the replay ends in another state than it was recorded with\n", file);
  return same;
}

/// Text of an error without its place if that is the file named before it.
std::string text_without_file(Error error, const std::string& file) {
  if (error.place == file) error.place.clear();
  return error.text();
}

int run_check(const CheckLine& line) {
  nlohmann::ordered_json out = {{"ok", true}, {"files", nlohmann::ordered_json::array()}};
  int code = exit_ok;
  for (const std::string& file : line.files) {
    std::vector<Fault> faults;
    std::vector<std::string> warnings;
    SceneRequest request;
    request.scene = file;
    request.overrides = line.overrides;
    request.threads = 1;
    request.log = [&warnings](LogLevel level, std::string_view message) {
      if (level >= LogLevel::warning) warnings.emplace_back(message);
    };
    const auto scene = load_scene_and_world(request, &faults);
    if (!scene && faults.empty())
      faults.push_back(
          {.file = file, .path = {}, .message = text_without_file(scene.error(), file)});
    nlohmann::ordered_json one = {{"file", file}, {"ok", scene.ok()}};
    if (scene) {
      const auto& stats = scene->built.world->frame()->stats;
      one["bodies"] = stats.bodies;
      one["particles"] = stats.particles;
      report_overlaps(*scene->built.world, warnings, one);
      if (!line.json)
        fmt::print("{}: ok, {} bodies, {} particles\n", file, stats.bodies, stats.particles);
      if (const JointRank rank = joint_rank(scene->built); rank.rows > 0) {
        one["joint_rows"] = rank.rows;
        one["joint_rank"] = rank.rank;
        one["dependent_joints"] = nlohmann::ordered_json::array();
        for (const auto& [name, rows] : rank.dependent)
          one["dependent_joints"].push_back({{"name", name}, {"rows", rows}});
        if (!line.json) fmt::print("{}: {}\n", file, text_of(rank));
      }
      if (!scene->built.assembly.empty()) one["assembly"] = scene->built.assembly;
      if (!line.json)
        for (const std::string& moved : scene->built.assembly) fmt::print("{}: {}\n", file, moved);
      const auto assertions = line.run ? SceneAssertions::make(scene->built) : nullptr;
      if (assertions &&
          !run_assertions(*scene->built.world, *assertions, line.seconds, file, one)) {
        one["ok"] = false;
        code = code == exit_ok ? exit_negative : code;
      }
      if (line.run && !run_replay_of(*scene, file, one)) {
        one["ok"] = false;
        code = code == exit_ok ? exit_negative : code;
      }
      const bool teaches = scene->built.description->lesson.has_value();
      if (line.run && teaches && !run_lesson(request, file, one)) {
        one["ok"] = false;
        code = code == exit_ok ? exit_negative : code;
      }
    } else {
      code = scene.error().code == ErrorCode::invalid_argument ? exit_usage : exit_bad_input;
    }
    one["warnings"] = warnings;
    one["faults"] = nlohmann::ordered_json::array();
    for (const Fault& f : faults) {
      one["faults"].push_back(fault_json(f));
      fmt::print(stderr, "{}\n", f.text());
    }
    for (const std::string& w : warnings) fmt::print(stderr, "{}: warning: {}\n", file, w);
    out["files"].push_back(std::move(one));
  }
  out["ok"] = code == exit_ok;
  if (line.json)
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  return code;
}

}  // namespace

CommandAction declare_check(Options& options) {
  auto line = std::make_shared<CheckLine>();
  options.value("files", line->files, "scene, robot or mesh files, or names of `tumble scenes`")
      .required();
  options.value("--set", line->overrides, "path=value, as for `render`").one_each();
  const Option run = options.flag(
      "--run", line->run,
      "run scenes until the last of their assertions is decided, with them the questions of "
      "lessons, and the replays of packs");
  options.value("--seconds", line->seconds, "with --run: simulated time of scenes that assert")
      .between(0.0, 1e6)
      .needs(run);
  options.flag("--json", line->json, "one JSON object on stdout");
  options.footer(
      "Every fault is printed as FILE:LINE: PATH: what is wrong. 0 when all are right, else 3; "
      "with\n"
      "--run 1 when an assertion fails or is not reached, or the answer of a lesson is not the "
      "world's.\n"
      "A run ends at the last moment (`at`) that the assertions name; where none does, it takes "
      "10 s.\n"
      "Of scenes for the event stepper it says which bodies overlap at the start; of joints, how "
      "many of\n"
      "the equations that they, their motors and couplings ask for are independent of each other, "
      "and which\n"
      "joints have some that others hold too (--json: joint_rows, joint_rank, "
      "dependent_joints[name rows]).\n\n"
      "Examples:\n"
      "  tumble check my_scene.json\n"
      "  tumble check robot.urdf              what is not followed too, line by line\n"
      "  tumble check galton --run\n"
      "  tumble check scenes/*.json --json");
  return [line] { return run_check(*line); };
}

}  // namespace tumble
