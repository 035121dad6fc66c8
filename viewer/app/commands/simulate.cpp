#include "engine/core/hash.hpp"
#include "engine/core/text.hpp"
#include "engine/math/expression.hpp"
#include "engine/scene/pack/pack.hpp"
#include "engine/world/replay.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/command.hpp"
#include "viewer/app/commands/file_roles.hpp"
#include "viewer/app/commands/simulate_export.hpp"
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/scenes/quantities.hpp"
#include "viewer/app/scenes/saved_states.hpp"
#include "viewer/app/scenes/scene_assertions.hpp"
#include "viewer/app/scenes/scene_files.hpp"
#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/app/simulate/certificates_file.hpp"
#include "viewer/app/simulate/convergence.hpp"
#include "viewer/app/simulate/outputs.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/frame_clock.hpp"
#include "viewer/capture/stop_signal.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Clock = std::chrono::steady_clock;

struct SimulateLine {
  SceneRequest request;
  std::string seconds;
  std::optional<uint64_t> steps;
  std::string csv, contacts, joints, trace, replay;
  std::string hash;  ///< empty: none; "final"; or the number of ticks between hashes
  std::vector<std::string> asserts;
  ExportLine particles;
  bool json = false;
  bool convergence = false;
};

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// All output files of a run.
struct Outputs {
  EnergyCsv csv;
  ContactCsv contacts;
  JointCsv joints;
  StageTrace trace;
  ParticleExport particles;
  StateExport states;

  Status status() const {
    for (const Status& s : {csv.status(), contacts.status(), joints.status(), trace.status(),
                            particles.status(), states.status()})
      if (!s) return s;
    return {};
  }
  Status commit() {
    for (const Status& s : {csv.commit(), contacts.commit(), joints.commit(), trace.commit(),
                            particles.commit(), states.commit()})
      if (!s) return s;
    return {};
  }
};

std::string unknown_quantity(const std::string& name, const BuiltScene& scene) {
  const std::string near = nearest_word(name, quantity_names(scene));
  return "unknown quantity '" + name + "'" + (near.empty() ? "" : ", did you mean '" + near + "'?");
}

/// Parses the assertions and checks that every name in them exists.
Result<std::vector<Expression>> parse_asserts(const std::vector<std::string>& texts,
                                              const BuiltScene& scene) {
  std::vector<Expression> out;
  const auto frame = scene.world->frame();
  for (const std::string& text : texts) {
    auto expression = Expression::parse(text);
    if (!expression)
      return Error{
          ErrorCode::invalid_argument, expression.error().text(), "--assert '" + text + "'", {}};
    if (!expression->is_condition())
      return Error{ErrorCode::invalid_argument, "a quantity, but nothing is said of it",
                   "--assert '" + text + "'",
                   "compare it, and each part of an && or ||, as in --assert "
                   "'bodies.ball.asleep == 1'"};
    for (const std::string& name : expression->names())
      if (!quantity(scene, *frame, name))
        return Error{ErrorCode::invalid_argument, unknown_quantity(name, scene),
                     "--assert '" + text + "'", "known are:\n  " + quantity_help()};
    out.push_back(*std::move(expression));
  }
  return out;
}

/// Evaluates the assertions on the final frame; prints each that fails with the values of its
/// names.
bool judge_asserts(const std::vector<Expression>& expressions,
                   const std::vector<std::string>& texts, const BuiltScene& scene) {
  const auto frame = scene.world->frame();
  const auto lookup = [&](std::string_view name) { return quantity(scene, *frame, name); };
  bool all = true;
  for (size_t i = 0; i < expressions.size(); ++i) {
    const auto value = expressions[i].evaluate(lookup);
    if (value && *value != 0) continue;
    all = false;
    std::string values;
    for (const std::string& name : expressions[i].names())
      if (const auto v = lookup(name)) values += fmt::format("\n  {} = {}", name, *v);
    fmt::print(stderr, "tumble: assertion failed after {} s: {}{}{}\n", frame->time, texts[i],
               value ? "" : ": " + value.error().text(), values);
  }
  return all;
}

/// Outcome of a run.
struct RunResult {
  Status step;
  Status outputs;
  double wall_seconds = 0;
};

RunResult run_ticks(World& world, uint64_t ticks, uint64_t hash_every, const StopSignal& stop,
                    SceneAssertions* assertions, ReplayPlayer* player, Outputs& out) {
  RunResult result;
  const auto start = Clock::now();
  world.stop_with(&stop.flag());
  auto frame = world.frame();
  if (assertions) assertions->see(*frame);
  out.csv.add(*frame);
  result.step = out.joints.add(world);
  (void)out.particles.add(world);  // the error is in status()
  (void)out.states.add(world);
  result.outputs = out.status();
  while (result.step && result.outputs && world.tick() < ticks && !stop.requested()) {
    const double begin = since(start);
    if (const auto report = world.step(); !report) {
      if (report.error().code != ErrorCode::cancelled) result.step = report.error();
      break;
    }
    if (player) result.step = player->follow(world);
    frame = world.frame();
    if (assertions) assertions->see(*frame);
    out.trace.add(frame->tick, frame->stats.stages, begin, since(start) - begin);
    out.csv.add(*frame);
    out.contacts.add(*frame);
    if (Status joints = out.joints.add(world); !joints) {
      if (joints.error().code != ErrorCode::cancelled) result.step = std::move(joints);
      break;
    }
    if (hash_every > 0 && frame->tick % hash_every == 0 && frame->tick < ticks)
      fmt::print("{} {}\n", frame->tick, hash_text(world.state_hash()));
    (void)out.particles.add(world);
    (void)out.states.add(world);
    result.outputs = out.status();
    if (!result.outputs) break;
  }
  result.wall_seconds = since(start);
  return result;
}

/// Energy contributed by every cause, as JSON.
nlohmann::ordered_json ledger_json(const Ledger& ledger) {
  nlohmann::ordered_json out;
  for (size_t i = 0; i < ledger_lines; ++i) {
    const LedgerEntry e = ledger.line(LedgerLine(i)).total();
    out[std::string(ledger_line_name(LedgerLine(i)))] = {{"work", e.work}, {"balance", e.balance}};
  }
  return out;
}

void print_summary(const World& world, const RunResult& run, bool asserted, bool json) {
  const auto frame = world.frame();
  const StepStats& s = frame->stats;
  const double speed = run.wall_seconds > 0 ? frame->time / run.wall_seconds : 0;
  if (!json) {
    fmt::print(stderr,
               "{} ticks, {:.4g} s simulated in {:.3g} s ({:.1f} times real time), {} bodies, {} "
               "awake, {} contacts, energy {:.6g} J\n",
               frame->tick, frame->time, run.wall_seconds, speed, s.bodies, s.awake, s.contacts,
               s.energies.total());
    return;
  }
  const nlohmann::ordered_json out = {
      {"ticks", frame->tick},
      {"time", frame->time},
      {"wall_seconds", run.wall_seconds},
      {"state_hash", hash_text(world.state_hash())},
      {"bodies", s.bodies},
      {"awake", s.awake},
      {"contacts", s.contacts},
      {"contact_points", s.contact_points},
      {"max_penetration", s.max_penetration},
      {"energies",
       {{"kinetic", s.energies.kinetic},
        {"gravity", s.energies.gravity},
        {"springs", s.energies.springs},
        {"fields", s.energies.fields},
        {"total", s.energies.total()}}},
      {"energy_drift", frame->ledger->drift()},
      {"energy_throughput", frame->ledger->throughput()},
      {"ledger", ledger_json(*frame->ledger)},
      {"momentum", {s.momentum.x(), s.momentum.y(), s.momentum.z()}},
      {"angular_momentum",
       {s.angular_momentum.x(), s.angular_momentum.y(), s.angular_momentum.z()}},
      {"assertions_hold", asserted}};
  fmt::print("{}\n", out.dump(2));
}

/// The number of ticks requested, else that of the replay; an error if neither, or both ways of
/// giving it.
Result<uint64_t> ticks_of(const SimulateLine& line, TickRate rate,
                          const ReplayPlayer* player = nullptr) {
  if (player && !line.steps && line.seconds.empty()) return player->last_tick();
  if (line.steps && !line.seconds.empty())
    return Error{ErrorCode::invalid_argument,
                 "--seconds and --steps both say how long",
                 {},
                 "give one of the two"};
  if (!line.steps && line.seconds.empty())
    return Error{ErrorCode::invalid_argument, "how long?", {}, "give --seconds S or --steps N"};
  if (line.steps) return *line.steps;
  const auto seconds = parse_fraction(line.seconds, "--seconds", true);
  if (!seconds) return seconds.error();
  return tick_count(*seconds, rate);
}

/// Ticks between two printed hashes; 0 for the final one only.
Result<uint64_t> hash_interval(const std::string& text) {
  if (text.empty() || text == "final") return uint64_t{0};
  const auto every = parse_fraction(text, "--hash");
  if (!every || every->den != 1)
    return Error{
        ErrorCode::invalid_argument, "--hash: '" + text + "' is not a number of ticks", {}, {}};
  return uint64_t(every->num);
}

nlohmann::ordered_json order_json(const std::optional<double>& order) {
  return order ? nlohmann::ordered_json(*order) : nlohmann::ordered_json(nullptr);
}

/// Three runs and a table of convergence instead of one run.
int run_convergence(SimulateLine& line) {
  const StopSignal stop;
  const Stoppable scope(&stop.flag());
  line.request.log = stderr_log(LogLevel::warning);
  const auto scene = load_scene_and_world(line.request);
  if (stop.requested()) return stop.exit_code();
  if (!scene) return report(scene.error(), exit_code_of_scene(scene.error()));
  if (const auto player = replay_of(line.request, *scene); player && *player)
    fmt::print(stderr, "tumble: warning: {} is not played: it is of ticks of one length\n",
               (*player)->source());
  const auto ticks = ticks_of(line, scene->built.world->settings().tick);
  if (!ticks) return report(ticks.error(), exit_usage);
  line.request.log = {};  // its warnings were already logged
  const auto measured = measure_convergence(line.request, *ticks, &stop.flag());
  if (stop.requested()) return stop.exit_code();
  if (!measured) return report(measured.error(), exit_broken_down);
  if (!line.json) {
    fmt::print("{}", convergence_text(*measured));
    return exit_ok;
  }
  nlohmann::ordered_json out = {{"seconds", measured->seconds}, {"tick", measured->tick}};
  for (const ConvergenceRow& row : measured->rows)
    out[row.name] = {{"unit", row.unit}, {"errors", row.error}, {"order", order_json(row.order)}};
  out["ledger_drift"] = {{"values", measured->drift}, {"order", order_json(measured->drift_order)}};
  fmt::print("{}\n", out.dump(2));
  return exit_ok;
}

/// `--contacts FILE.json` writes certificates at the end of the run, other endings a CSV row per
/// contact and tick.
bool asks_certificates(const std::string& file) {
  return std::filesystem::path(file).extension() == ".json";
}

/// Exit code for an export that could not be written, or was not allowed to.
ExitCode exit_code_of_export(const Error& error) {
  if (error.code == ErrorCode::not_found) return exit_usage;
  return error.code == ErrorCode::internal ? exit_negative : exit_cannot_write;
}

/// Whether the run may have a replay, which would determine its length.
bool may_play(const SimulateLine& line) {
  const ReplayRequest& wanted = line.request.replay;
  return !line.convergence && !wanted.none && line.seconds.empty() && !line.steps &&
         (!wanted.file.empty() || is_pack_file(line.request.scene));
}

/// Contribution of a replay to the key that identifies equal runs; empty for none.
std::string key_of(const ReplayPlayer* player) {
  return player ? fmt::format("replay {} {:016x}", player->last_tick(), player->last_hash()) : "";
}

/// Whether a run must start at tick 0, because some output needs all ticks.
bool wants_beginning(const SimulateLine& line, const SceneAssertions* assertions,
                     const ReplayPlayer* player) {
  const bool every_hash = !line.hash.empty() && line.hash != "final";
  const std::array files = {&line.csv, &line.joints, &line.trace, &line.replay,
                            &line.particles.folder};
  return assertions || player || every_hash ||
         std::ranges::any_of(files, [](const auto* file) { return !file->empty(); }) ||
         (!line.contacts.empty() && !asks_certificates(line.contacts));
}

/// The files of a run; those that its scene refers to are added once it is read.
FileRoles files_of(const SimulateLine& line) {
  return FileRoles()
      .reads(line.request)
      .writes("--csv", line.csv)
      .writes("--contacts", line.contacts)
      .writes("--joints", line.joints)
      .writes("--trace", line.trace)
      .writes("--replay", line.replay)
      .writes("--export", line.particles.folder)
      .writes("--states", line.particles.states);
}

/// Writes what tells how a run came to its last good tick, however it ended.
Status write_replay(const SimulateLine& line, const World& world) {
  if (line.replay.empty()) return {};
  return write_file(line.replay, save_replay(world));
}

/// Writes the certificates of the contacts at the end.
std::optional<int> write_end(const SimulateLine& line, const World& world) {
  if (!asks_certificates(line.contacts)) return std::nullopt;
  const Status written = write_certificates(world, line.contacts);
  if (written) return std::nullopt;
  return report(written.error(),
                written.error().code == ErrorCode::io ? exit_cannot_write : exit_broken_down);
}

int run_simulate(SimulateLine& line) {
  const auto every = hash_interval(line.hash);
  if (!every) return report(every.error(), exit_usage);
  // A scene that does not exist is told before its length is asked for.
  if (const auto scene = find_scene(line.request.scene); !scene)
    return report(scene.error(), exit_code_of_scene(scene.error()));
  if (const auto ticks = ticks_of(line, {}); !ticks && !may_play(line))
    return report(ticks.error(), exit_usage);
  if (line.json && !line.hash.empty())
    return report({ErrorCode::invalid_argument,
                   "--json and --hash both print to stdout",
                   {},
                   "leave out --hash: the object has state_hash"},
                  exit_usage);

  FileRoles files = files_of(line);
  if (const Status apart = files.apart(); !apart) return report(apart.error(), exit_usage);
  if (std::error_code none;
      !line.replay.empty() && !line.particles.force && std::filesystem::exists(line.replay, none))
    return report({ErrorCode::io, "is there already, and would be lost", line.replay,
                   "--force overwrites it, or name another"},
                  exit_cannot_write);
  if (line.convergence) return run_convergence(line);
  line.request.log = stderr_log(LogLevel::warning);
  auto scene = load_scene_and_world(line.request);
  if (!scene) return report(scene.error(), exit_code_of_scene(scene.error()));
  if (const Status apart = files.reads(*scene->built.description).apart(); !apart)
    return report(apart.error(), exit_usage);
  World& world = *scene->built.world;
  const std::string start =
      line.particles.states.empty() ? "" : start_of_run(world, TUMBLE_VERSION);
  const auto player = replay_of(line.request, *scene);
  if (!player) return report(player.error(), exit_code_of_scene(player.error()));
  if (*player) fmt::print(stderr, "{}\n", replay_words(line.request, *scene, **player));
  const auto wanted = ticks_of(line, world.settings().tick, player->get());
  if (!wanted) return report(wanted.error(), exit_usage);
  const auto asserts = parse_asserts(line.asserts, scene->built);
  if (!asserts) return report(asserts.error(), exit_usage);

  const StopSignal stop;  // before there are files that an early Ctrl-C would leave behind
  const bool certified = asks_certificates(line.contacts);
  const uint64_t ticks = *wanted;
  const auto export_plan = export_options(line.particles, line.request, *scene, ticks);
  if (!export_plan) return report(export_plan.error(), exit_usage);
  auto particles = ParticleExport::begin(world, *export_plan);
  if (!particles) return report(particles.error(), exit_code_of_export(particles.error()));
  const auto states_plan =
      state_options(line.particles, line.request, *scene, start, key_of(player->get()), ticks);
  if (!states_plan) return report(states_plan.error(), exit_usage);
  auto states = StateExport::begin(*states_plan);
  if (!states) return report(states.error(), exit_code_of_export(states.error()));
  Outputs outputs{EnergyCsv(line.csv, names_of(scene->built)),
                  ContactCsv(certified ? "" : line.contacts),
                  JointCsv(line.joints),
                  StageTrace(line.trace),
                  *std::move(particles),
                  *std::move(states)};
  if (auto s = outputs.status(); !s) return report(s.error(), exit_cannot_write);
  const std::shared_ptr<SceneAssertions> of_scene = SceneAssertions::make(scene->built);
  if (line.particles.resume && !wants_beginning(line, of_scene.get(), player->get()))
    if (auto s = outputs.states.skip(world); !s)
      return report(s.error(), exit_code_of_export(s.error()));
  const RunResult run =
      run_ticks(world, ticks, *every, stop, of_scene.get(), player->get(), outputs);
  if (stop.requested()) world.stop_with(nullptr);  // what is written of the end is whole
  if (auto s = outputs.commit(); !s) return report(s.error(), exit_code_of_export(s.error()));
  const Status kept = write_replay(line, world);
  if (!run.step) {
    if (!line.replay.empty() && kept)
      fmt::print(stderr, "the {} ticks before it are in {}\n", world.tick(), line.replay);
    return report(run.step.error(), exit_broken_down);
  }
  if (!kept) return report(kept.error(), exit_cannot_write);
  if (const auto code = write_end(line, world)) return *code;
  if (stop.requested()) {
    fmt::print(stderr, "stopped at tick {} of {}, {:.4g} s\n", world.tick(), ticks, world.time());
    return stop.exit_code();
  }

  bool holds = judge_asserts(*asserts, line.asserts, scene->built);
  if (of_scene) {
    of_scene->finish(*world.frame());
    const std::vector<AssertionView> verdicts = of_scene->views();
    fmt::print(stderr, "{}", verdict_text(verdicts));
    holds = holds && !any_fails(verdicts);
  }
  print_summary(world, run, holds, line.json);
  if (outputs.particles.wanted() && !line.json)
    fmt::print(stderr, "{} frames of particles in {}, {} of them there before\n",
               outputs.particles.frames(), line.particles.folder, outputs.particles.frames_kept());
  if (outputs.states.wanted() && !line.json)
    fmt::print(stderr, "{} states in {}, {} of them there before\n", outputs.states.states(),
               line.particles.states, outputs.states.states_kept());
  if (!line.hash.empty()) fmt::print("{}\n", hash_text(world.state_hash()));
  if (*player)
    if (const Status same = (*player)->verdict(); !same) return report(same.error(), exit_negative);
  return holds ? exit_ok : exit_negative;
}

}  // namespace

CommandAction declare_simulate(Options& options) {
  auto line = std::make_shared<SimulateLine>();
  options.value("scene", line->request.scene, "scene file, or a name of `tumble scenes`")
      .required();
  options
      .value("--seconds", line->seconds,
             "simulated time, e.g. 2.5; with a replay that of the replay, unless given")
      .not_empty();
  options.value("--steps", line->steps, "instead: number of ticks").natural();
  options.value("--threads", line->request.threads, "0: one per core; results do not depend on it")
      .between(0, 1024);
  options.value("--stepper", line->request.stepper, "instead of the scene's");
  options.value("--set", line->request.overrides, "path=value, e.g. bodies.ball.mass=3").one_each();
  const auto file = [&](const char* name, std::string& to, const char* doc) {
    return options.value(name, to, doc).not_empty();
  };
  const Option csv =
      file("--csv", line->csv,
           "energies, momenta, contacts, work of every cause and times per stage, a row a tick");
  const Option contacts =
      file("--contacts", line->contacts,
           "every contact of every tick as CSV; a .json file gets the certificates of "
           "the contacts at the end");
  const Option joints = file("--joints", line->joints,
                             "force and torque of every joint as CSV: at each tick, and the "
                             "means over the tick before");
  const Option trace = file("--trace", line->trace, "times per stage as a Chrome trace");
  const Option replay = file(
      "--replay", line->replay,
      "the run as a replay, for `tumble pack --replay`: what was done, and the hash; up to where "
      "it was interrupted or broke down");
  declare_replay(options, line->request.replay);
  const Option hash =
      options.flag("--hash{final}", line->hash,
                   "print the state hash at the end, with =EVERY also every so many ticks");
  const Option asserts =
      options.value("--assert", line->asserts, "expression that must hold at the end, else exit 1")
          .one_each();
  const auto [particles, states] = declare_export(options, line->particles);
  options
      .flag("--convergence", line->convergence,
            "instead: runs with the tick, half and a quarter of it, errors and observed order")
      .excludes(csv)
      .excludes(contacts)
      .excludes(joints)
      .excludes(trace)
      .excludes(replay)
      .excludes(hash)
      .excludes(asserts)
      .excludes(particles)
      .excludes(states);
  options.flag("--json", line->json, "one JSON object on stdout");
  options.footer(
      "The assertions of the scene are judged too; one that fails ends with 1.\n\n"
      "Quantities of --assert:\n  " +
      quantity_help() +
      "\n\nExamples:\n"
      "  tumble simulate tower --seconds 10 --csv tower.csv\n"
      "  tumble simulate tower --seconds 2 --hash\n"
      "  tumble simulate pendulums --seconds 2 --joints forces.csv\n"
      "  tumble simulate cradle --seconds 5 --assert 'energy.drift < 1e-3'\n"
      "  tumble simulate dominoes --seconds 1 --set settings.tick_hz=240 --trace trace.json\n"
      "  tumble simulate my_scene.json --play run.bin --hash    ends where the replay does\n"
      "  tumble simulate fountain --seconds 4 --export drops --format vtu --fps 60");
  return [line] { return run_simulate(*line); };
}

}  // namespace tumble
