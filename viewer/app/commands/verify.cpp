#include "engine/world/world.hpp"
#include "viewer/app/command.hpp"
#include "viewer/app/commands/file_roles.hpp"
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/verify/differences.hpp"
#include "viewer/app/verify/lockstep.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/stop_signal.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

struct VerifyLine {
  std::string scene;
  std::vector<std::string> common, a, b;  ///< "path=value"
  int threads_a = 1, threads_b = 0;
  double seconds = 5, tolerance = 0;
  std::string csv;
  bool json = false;
};

/// Names in the error the option that caused it.
Error of_option(Error error, std::string_view option) {
  constexpr std::string_view any = "--set";
  for (std::string* text : {&error.place, &error.message})
    for (size_t at = 0; (at = text->find(any, at)) != std::string::npos; at += option.size())
      text->replace(at, any.size(), option);
  return error;
}

/// One of the two worlds and its options.
struct Side {
  LoadedScene scene;
  WorldChoice choice;
};

Result<Side> load_side(const VerifyLine& line, std::vector<std::string> own,
                       std::string_view option, int threads) {
  WorldChoice choice;
  choice.threads = threads;
  if (const Status taken = take_machine(own, choice); !taken) {
    Error error = taken.error();
    error.place = fmt::format("{} {}", option, error.place);
    return error;
  }
  SceneRequest request;
  request.scene = line.scene;
  request.overrides = line.common;
  const bool common_is_fine = own.empty() || read_scene_request(request).ok();
  request.overrides.insert(request.overrides.end(), own.begin(), own.end());
  request.threads = choice.threads;
  request.log = stderr_log(LogLevel::warning);
  auto loaded = load_scene_and_world(request);
  if (!loaded && !own.empty() && common_is_fine) return of_option(loaded.error(), option);
  if (!loaded) return loaded.error();
  choice.settings = loaded->built.world->settings();
  choice.numbers = numbers_of(*loaded->built.description);
  return Side{*std::move(loaded), std::move(choice)};
}

/// What is compared, and the result.
struct Comparison {
  double tolerance = 0;
  uint64_t moments = 0;
  std::optional<Divergence> first;                 ///< first divergence beyond the tolerance
  std::optional<ContactDifference> first_contact;  ///< at that time
  Divergence worst, last;

  bool beyond(const Divergence& d) const {
    return tolerance > 0 ? !(d.distance <= tolerance) : !d.same_bits;
  }
  void see(const Divergence& d) {
    ++moments;
    if (!first && beyond(d)) first = d;
    if (moments == 1 || d.distance > worst.distance) worst = d;
    last = d;
  }
};

nlohmann::ordered_json number_json(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json("infinite");
}

nlohmann::ordered_json divergence_json(const Divergence& d) {
  return {{"time", d.time},           {"tick_a", d.tick_a},
          {"tick_b", d.tick_b},       {"distance", number_json(d.distance)},
          {"angle", d.angle},         {"speed", d.speed},
          {"same_bits", d.same_bits}, {"what", d.what}};
}

/// Distance for display; infinite if only one of the worlds has the body.
std::string apart_words(double distance) {
  return std::isfinite(distance) ? fmt::format("by {:.3g} m", distance)
                                 : std::string("which only one of the two worlds has");
}

nlohmann::ordered_json differences_json(const std::vector<WorldDifference>& differences) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const WorldDifference& d : differences)
    out.push_back({{"path", d.path}, {"a", d.value_a}, {"b", d.value_b}});
  return out;
}

/// A value as --set takes it, except that defaults ("" and 0) are spelt out.
std::string shown_value(const WorldDifference& d, const std::string& value) {
  if (d.path == "threads" && value == "0") return "one per core";
  return value.empty() ? "the best" : value;
}

void print_result(const Comparison& found, const std::vector<WorldDifference>& differences,
                  bool json) {
  if (json) {
    nlohmann::ordered_json out = {{"differences", differences_json(differences)},
                                  {"agrees", !found.first},
                                  {"moments", found.moments},
                                  {"tolerance", found.tolerance},
                                  {"worst", divergence_json(found.worst)},
                                  {"last", divergence_json(found.last)}};
    if (found.first) out["first"] = divergence_json(*found.first);
    if (found.first_contact) out["first_contact"] = found.first_contact->what;
    fmt::print("{}\n", out.dump(2));
    return;
  }
  for (const WorldDifference& d : differences)
    fmt::print("{}: A {}, B {}\n", d.path, shown_value(d, d.value_a), shown_value(d, d.value_b));
  if (!found.first) {
    if (found.tolerance > 0)
      fmt::print("A and B stay within {} m of each other for {} s (at most {:.3g} m)\n",
                 found.tolerance, found.last.time, found.worst.distance);
    else
      fmt::print("A and B have the same bits at {} moments, up to {} s\n", found.moments,
                 found.last.time);
    return;
  }
  const Divergence& d = *found.first;
  fmt::print("A and B differ from {} s on (tick {} of A, {} of B)\n", d.time, d.tick_a, d.tick_b);
  if (!d.what.empty()) fmt::print("first: {}, {}\n", d.what, apart_words(d.distance));
  if (d.angle > 0 || d.speed > 0)
    fmt::print("       bodies by {:.3g} rad, velocities by {:.3g} m/s\n", d.angle, d.speed);
  if (found.first_contact) fmt::print("first contact: {}\n", found.first_contact->what);
  if (!found.worst.what.empty())  // else all are in the same places
    fmt::print("worst: {} at {} s, {}\n", found.worst.what, found.worst.time,
               apart_words(found.worst.distance));
}

/// The row of a path; a new one has nothing but what the scene says. Of a path that is given
/// several times the last value holds, as it does in the world.
WorldDifference& difference_at(std::vector<WorldDifference>& rows, const std::string& path) {
  const auto known = std::ranges::find(rows, path, &WorldDifference::path);
  if (known != rows.end()) return *known;
  const std::string scene = "as the scene has it";
  return rows.emplace_back(WorldDifference{path, scene, scene, scene, scene});
}

/// Overrides of bodies and the like are listed as typed; of settings, numbers and machine the
/// resulting values are listed.
std::vector<WorldDifference> all_differences(const VerifyLine& line, const Side& a, const Side& b) {
  std::vector<WorldDifference> out = differences(a.choice, b.choice);
  const auto is_chosen = [](const std::string& one) {
    return one.starts_with("settings.") || one.starts_with("parameters.") ||
           one.find('.') >= one.find('=');
  };
  for (const auto& [own, which] : {std::pair(&line.a, 'a'), std::pair(&line.b, 'b')})
    for (const std::string& one : *own) {
      if (is_chosen(one)) continue;
      const std::string path = one.substr(0, one.find('=')), value = one.substr(path.size() + 1);
      WorldDifference& d = difference_at(out, path);
      (which == 'a' ? d.value_a : d.value_b) = value;
      (which == 'a' ? d.words_a : d.words_b) = value;
    }
  return out;
}

int run_verify(const VerifyLine& line) {
  SceneRequest common;
  common.scene = line.scene;
  FileRoles files;
  files.reads(common).writes("--csv", line.csv);
  if (const Status apart = files.apart(); !apart) return report(apart.error(), exit_usage);
  const auto a = load_side(line, line.a, "--a", line.threads_a);
  if (!a) return report(a.error(), exit_code_of_scene(a.error()));
  const auto b = load_side(line, line.b, "--b", line.threads_b);
  if (!b) return report(b.error(), exit_code_of_scene(b.error()));
  for (const auto* side : {&*a, &*b}) files.reads(*side->scene.built.description);
  if (const Status apart = files.apart(); !apart) return report(apart.error(), exit_usage);
  const StopSignal stop;
  FileWriter csv(line.csv);
  csv.append("time,distance,angle,speed,same_bits,what\n");
  Comparison found;
  found.tolerance = line.tolerance;
  for (const auto* side : {&*a, &*b}) side->scene.built.world->stop_with(&stop.flag());
  World &world_a = *a->scene.built.world, &world_b = *b->scene.built.world;
  const LockstepSide side_a{world_a, a->choice.simd}, side_b{world_b, b->choice.simd};
  const Status ran = run_lockstep(side_a, side_b, line.seconds, [&](const Divergence& d) {
    const bool apart = found.first.has_value();
    found.see(d);
    if (found.first && !apart)
      found.first_contact = first_contact_difference(*world_a.frame(), *world_b.frame());
    csv.append(fmt::format("{},{},{},{},{},\"{}\"\n", d.time, d.distance, d.angle, d.speed,
                           int(d.same_bits), d.what));
    // Without a CSV file, nothing after the first divergence is needed.
    return !stop.requested() && (csv.wanted() || !found.first);
  });
  if (stop.requested()) return stop.exit_code();
  if (const Status written = csv.commit(); !written)
    return report(written.error(), exit_cannot_write);
  if (!ran) return report(ran.error(), exit_broken_down);
  print_result(found, all_differences(line, *a, *b), line.json);
  return found.first ? exit_negative : exit_ok;
}

}  // namespace

CommandAction declare_verify(Options& options) {
  auto line = std::make_shared<VerifyLine>();
  options.value("scene", line->scene, "scene file, or a name of `tumble scenes`").required();
  options.value("--a", line->a, "path=value, for world A only; threads=N and simd=NAME too")
      .one_each();
  options.value("--b", line->b, "path=value, for world B only; threads=N and simd=NAME too")
      .one_each();
  options.value("--set", line->common, "path=value, for both").one_each();
  options.value("--threads-a", line->threads_a, "of world A; 0: one per core")
      .shows_default()
      .between(0, 1024);
  options.value("--threads-b", line->threads_b, "of world B; 0: one per core")
      .shows_default()
      .between(0, 1024);
  options.value("--seconds", line->seconds, "simulated time").between(0.0, 1e6).shows_default();
  options
      .value("--tolerance", line->tolerance,
             "how far apart the two may be [m]; 0: they must have the same bits")
      .between(0.0, 1e6)
      .shows_default();
  options.value("--csv", line->csv, "how far they are apart at every common tick").not_empty();
  options.flag("--json", line->json, "one JSON object on stdout");
  options.footer(
      "Steps the same scene twice, side by side. Exit code 1 where the two differ, with the "
      "moment\n"
      "and the body or particle that is farthest off; without --csv it ends there.\n\n"
      "Examples:\n"
      "  tumble verify tower                                    one thread against all: same "
      "bits?\n"
      "  tumble verify pendulums --a settings.stepper=event --b settings.stepper=realtime "
      "--tolerance 0.01\n"
      "  tumble verify cradle --a settings.tick_hz=60 --b settings.tick_hz=240 --tolerance 0.001 "
      "--csv apart.csv\n"
      "  tumble verify tower --a simd=SCALAR --b threads=3\n"
      "  tumble verify mesh_pile --a settings.hierarchy=obb --b settings.hierarchy=aabb");
  return [line] { return run_verify(*line); };
}

}  // namespace tumble
