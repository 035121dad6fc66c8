// Reference: the manual's account of the command; the definitions of the workloads for counts.
#include "tests/viewer/cli/program.hpp"

#include <fstream>
#include <set>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;
using nlohmann::json;

namespace {

std::string content(const std::filesystem::path& file) {
  std::stringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

}  // namespace

TEST_CASE("bench prints one JSON object with every figure of every workload named") {
  const ProgramRun run =
      tumble_program({"bench", "--json", "W2", "W5", "--small", "--steps", "5", "--threads", "1"});
  CHECK(run.code == 0);
  CHECK(run.err.empty());
  const json told = json::parse(run.out, nullptr, false);
  REQUIRE(told.is_object());
  REQUIRE(told["results"].size() == 2);
  const json &towers = told["results"][0], &net = told["results"][1];
  CHECK(towers["workload"] == "W2");
  CHECK(towers["bodies"] == 90);
  CHECK(towers["joints"] == 0);
  CHECK(net["workload"] == "W5");
  CHECK(net["bodies"] == 96);
  CHECK(net["joints"] == 180);
  for (const json& r : told["results"]) {
    CHECK(r["small"] == true);
    CHECK(r["steps"] == 5);
    CHECK(r["threads"] == 1);
    CHECK(r["escaped"] == 0);
    for (const char* key :
         {"mean_ms_per_step", "median_ms_per_step", "p95_ms_per_step", "max_ms_per_step",
          "cpu_ms_per_step", "pairs", "contacts", "contact_points", "max_penetration_mm",
          "mean_penetration_mm", "joint_gap_mm", "kinetic_energy_J", "max_speed_m_per_s",
          "peak_memory_mb", "bytes_per_body", "bytes_per_contact"})
      CHECK_MESSAGE(r[key].is_number(), key);
    for (const char* stage : {"solve", "books"})
      CHECK_MESSAGE(r["stages_ms_per_step"][stage].is_number(), stage);
    CHECK(r["state_hash"].get<std::string>().size() == 16);
  }
}

TEST_CASE("bench gives the same state for any thread count, and again") {
  const auto hash = [](const char* threads) {
    const ProgramRun run = tumble_program({"bench", "W6", "--small", "--steps", "30", "--repeat",
                                           "2", "--json", "--threads", threads});
    CHECK(run.code == 0);
    const json told = json::parse(run.out, nullptr, false);
    REQUIRE(told.is_object());
    REQUIRE(told["results"].size() == 1);
    return told["results"][0]["state_hash"].get<std::string>();
  };
  CHECK(hash("1") == hash("2"));
}

TEST_CASE("bench prints a table, and writes JSON and a trace of the stages beside it") {
  TempFolder folder;
  const std::string results = (folder / "r.json").string(), trace = (folder / "t.json").string();
  const ProgramRun run = tumble_program(
      {"bench", "W1", "W7c", "--small", "--steps", "4", "--json=" + results, "--trace", trace});
  CHECK(run.code == 0);
  CHECK(mentions(run.out, "W1 small"));
  CHECK(mentions(run.out, "W7c small"));
  CHECK(mentions(run.out, "narrow phase"));
  CHECK(json::parse(content(results), nullptr, false)["results"].size() == 2);
  const json events = json::parse(content(trace), nullptr, false)["traceEvents"];
  REQUIRE(events.is_array());
  std::set<std::string> names;
  int steps = 0;
  double last = -1;
  for (const json& e : events) {
    names.insert(e["name"].get<std::string>());
    if (e["name"] != "step") continue;
    ++steps;
    CHECK(e["ts"].get<double>() >= last);  // one workload after the other
    last = e["ts"].get<double>() + e["dur"].get<double>();
  }
  CHECK(steps == 8);
  for (const char* stage : {"broad phase", "narrow phase", "solve"})
    CHECK_MESSAGE(names.contains(stage), stage);
}

TEST_CASE("bench takes settings, refuses what it does not know, and says so by its code") {
  const auto code = [](std::vector<std::string> more) {
    std::vector<std::string> words{"bench", "W2", "--small", "--steps", "2"};
    words.insert(words.end(), more.begin(), more.end());
    return tumble_program(words).code;
  };
  CHECK(code({"--set", "settings.realtime.substeps=2"}) == 0);
  CHECK(code({"--set", "settings.realtime.substeps=0"}) == 2);
  CHECK(code({"--set", "settings.nonsense=1"}) == 2);
  CHECK(code({"--set", "settings.gravity=[0,-1e9,0]"}) == 6);
  CHECK(code({"--json=/nonexistent/x.json"}) == 5);
  CHECK(code({"--trace", "/proc/x"}) == 5);
  CHECK(code({"--threads", "-1"}) == 2);
  CHECK(code({"--steps", "0"}) == 2);
  const ProgramRun unknown = tumble_program({"bench", "W99"});
  CHECK(unknown.code == 2);
  CHECK(mentions(unknown.err, "'W99'"));
  CHECK(unknown.out.empty());
}
