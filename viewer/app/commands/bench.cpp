#include "engine/core/registry.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/workloads/run.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/bench/report.hpp"
#include "viewer/app/command.hpp"
#include "viewer/app/commands/file_roles.hpp"
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/simulate/outputs.hpp"
#include "viewer/capture/stop_signal.hpp"

#include <memory>

#include <fmt/format.h>

namespace tumble {
namespace {

struct BenchLine {
  std::vector<std::string> names, overrides;
  int threads = 1, repeat = 1;
  std::optional<int> steps;
  bool small = false;
  std::string json;  ///< empty: none; "-": stdout; or a file
  std::string trace;
  bool prints_table() const { return json != "-"; }
};

Result<std::vector<const WorkloadEntry*>> chosen(const std::vector<std::string>& names) {
  std::vector<const WorkloadEntry*> out;
  for (const std::string& name : names) {
    const auto entry = find_named(all_workloads(), name, "workload");
    if (!entry) return entry.error();
    out.push_back(*entry);
  }
  if (names.empty())
    for (const WorkloadEntry& entry : all_workloads()) out.push_back(&entry);
  return out;
}

/// Default settings with overrides.
Result<WorldSettings> settings_with(const std::vector<std::string>& overrides) {
  const SceneRead read = read_scene("{\"tumble_scene\": 1}", "--set", {overrides});
  if (!read.ok()) return to_error(read.faults);
  return read.scene.settings;
}

/// The results so far; of repeated runs, the one with the least processor time is kept.
class Results {
 public:
  /// Returns false if a repetition ended in a different state.
  bool add(WorkloadRun run) {
    for (WorkloadRun& known : runs_) {
      if (known.workload != run.workload) continue;
      const bool same = known.state_hash == run.state_hash;
      if (run.cpu.mean < known.cpu.mean) known = std::move(run);
      return same;
    }
    runs_.push_back(std::move(run));
    return true;
  }
  const std::vector<WorkloadRun>& runs() const { return runs_; }

 private:
  std::vector<WorkloadRun> runs_;
};

Error named(const WorkloadEntry& entry, Error error) {
  error.place = std::string(entry.name) + (error.place.empty() ? "" : ": " + error.place);
  return error;
}

/// Runs the workloads in turn, as often as requested, and prints a row as soon as it is final.
int run_all(const BenchLine& line, const std::vector<const WorkloadEntry*>& entries,
            WorkloadOptions options, StageTrace& trace, Results& results) {
  double start = 0, end = 0;  // of the present run, on the time axis of the trace [s]
  options.each = [&](const StepReport& report, double begin, double seconds) {
    trace.add(report.tick, report.stats.stages, start + begin, seconds);
    end = start + begin + seconds;
  };
  int code = exit_ok;
  for (int round = 0; round < line.repeat; ++round) {
    for (const WorkloadEntry* entry : entries) {
      start = end;
      auto run = run_workload(make_workload(*entry, line.small), options);
      if (options.stop->requested()) return code;
      if (!run) return report(named(*entry, run.error()), exit_broken_down);
      if (line.prints_table() && line.repeat == 1) fmt::print("{}", bench_row(*run));
      std::fflush(stdout);
      if (!results.add(*std::move(run)))
        code = report({ErrorCode::internal,
                       "two runs ended in different states",
                       std::string(entry->name),
                       {}},
                      exit_negative);
    }
  }
  return code;
}

int run_bench(const BenchLine& line) {
  const auto entries = chosen(line.names);
  if (!entries) return report(entries.error(), exit_usage);
  const auto settings = settings_with(line.overrides);
  if (!settings) return report(settings.error(), exit_usage);

  const FileRoles files =
      FileRoles().writes("--json", line.json == "-" ? "" : line.json).writes("--trace", line.trace);
  if (const Status apart = files.apart(); !apart) return report(apart.error(), exit_usage);
  const StopSignal stop;  // before there are files that an early Ctrl-C would leave behind
  StageTrace trace(line.trace);
  FileWriter json(line.json == "-" ? "" : line.json);
  for (const Status& s : {trace.status(), json.status()})
    if (!s) return report(s.error(), exit_cannot_write);
  WorkloadOptions options;
  options.settings = *settings;
  options.threads = line.threads;
  options.steps = line.steps;
  options.stop = &stop.flag();
  options.log = stderr_log(LogLevel::warning);
  if (line.prints_table()) fmt::print("{}", bench_head());
  Results results;
  const int code = run_all(line, *entries, options, trace, results);
  if (stop.requested()) return stop.exit_code();
  if (code == exit_broken_down) return code;
  if (line.prints_table() && line.repeat > 1)
    for (const WorkloadRun& run : results.runs()) fmt::print("{}", bench_row(run));
  const std::string text = bench_json(results.runs()) + "\n";
  if (line.json == "-") fmt::print("{}", text);
  json.append(text);
  for (const Status& s : {trace.commit(), json.commit()})
    if (!s) return report(s.error(), exit_cannot_write);
  return code;
}

std::string workload_list() {
  std::string out = "Workloads:\n";
  for (const WorkloadEntry& e : all_workloads()) out += fmt::format("  {:<5}{}\n", e.name, e.doc);
  return out;
}

}  // namespace

CommandAction declare_bench(Options& options) {
  auto line = std::make_shared<BenchLine>();
  options.value("name", line->names, "workloads; all of them if none is named");
  options.value("--threads", line->threads, "0: one per core; results do not depend on it")
      .between(0, 1024)
      .shows_default();
  options.value("--steps", line->steps, "instead of the workload's own number")
      .between(1, 100'000'000);
  options.flag("--small", line->small, "the small variant of each");
  options
      .value("--repeat", line->repeat,
             "run all so often in turn; the run of least processor time counts")
      .between(1, 1000)
      .shows_default();
  options.value("--set", line->overrides, "path=value, e.g. settings.realtime.substeps=8")
      .one_each();
  options.flag("--json{-}", line->json,
               "one JSON object on stdout; --json=FILE: into a file, beside the table");
  options.value("--trace", line->trace, "times per stage as a Chrome trace").not_empty();
  options.footer(
      workload_list() +
      "\nSteps of 1/60 s, nothing sleeps. Times are of World::step() in milliseconds; cpu is\n"
      "processor time of all threads. Pairs and contact points are means over the steps. What is\n"
      "left at the end is measured from the poses alone, not by what finds the contacts: the\n"
      "deepest and the mean overlap of bodies, the greatest gap of a joint, the speed of the\n"
      "fastest body, and how many bodies were lost (below -20 m, or nowhere). Below each row: "
      "mean\n"
      "time of each stage, greatest memory of the process, what the world's arrays hold for a "
      "body\n"
      "and for a contact at the end, hash of the final state.\n\n"
      "1 when repeated runs end in different states.\n\n"
      "Examples:\n"
      "  tumble bench W1 W3\n"
      "  tumble bench --threads 2 --json > here.json\n"
      "  tumble bench W4 --steps 100 --repeat 5 --trace w4.json");
  return [line] { return run_bench(*line); };
}

}  // namespace tumble
