#include "viewer/app/bench/report.hpp"

#include "engine/core/hash.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

nlohmann::ordered_json json_of(const WorkloadRun& r) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const StageMean& s : r.stages) stages[s.name] = s.milliseconds;
  return {{"workload", r.workload},
          {"small", r.small},
          {"threads", r.threads},
          {"steps", r.steps},
          {"bodies", r.bodies},
          {"joints", r.joints},
          {"particles", r.particles},
          {"mean_ms_per_step", r.wall.mean},
          {"median_ms_per_step", r.wall.median},
          {"p95_ms_per_step", r.wall.p95},
          {"max_ms_per_step", r.wall.most},
          {"cpu_ms_per_step", r.cpu.mean},
          {"cpu_median_ms_per_step", r.cpu.median},
          {"cpu_p95_ms_per_step", r.cpu.p95},
          {"cpu_max_ms_per_step", r.cpu.most},
          {"stages_ms_per_step", stages},
          {"pairs", r.pairs},
          {"contacts", r.contacts},
          {"contact_points", r.contact_points},
          {"max_penetration_mm", 1e3 * r.end.overlap.deepest},
          {"mean_penetration_mm", 1e3 * r.end.overlap.mean()},
          {"penetrating_pairs", r.end.overlap.pairs},
          {"joint_gap_mm", 1e3 * r.end.joint_gap},
          {"escaped", r.end.escaped},
          {"kinetic_energy_J", r.end.kinetic_energy},
          {"max_speed_m_per_s", r.end.fastest},
          {"peak_memory_mb", r.peak_memory},
          {"bytes_per_body", r.bytes_per_body()},
          {"bytes_per_contact", r.bytes_per_contact()},
          {"bytes_per_joint", r.bytes_per_joint()},
          {"state_hash", hash_text(r.state_hash)}};
}

}  // namespace

std::string bench_head() {
  return fmt::format(
             "{:<9}{:>7}{:>8}{:>6}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>8}{:>8}{:>7}\n",
             "", "bodies", "threads", "steps", "ms mean", "median", "p95", "max", "cpu", "pairs",
             "points", "deep mm", "mean mm", "gap mm", "m/s", "lost") +
         fmt::format("{:->137}\n", "");
}

std::string bench_row(const WorkloadRun& r) {
  std::string out = fmt::format(
      "{:<9}{:>7}{:>8}{:>6}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.0f}{:>9.0f}{:>9.2f}{:>9.3f}"
      "{:>8.2f}{:>8.3f}{:>7}\n",
      r.workload + (r.small ? " small" : ""), r.bodies + r.particles, r.threads, r.steps,
      r.wall.mean, r.wall.median, r.wall.p95, r.wall.most, r.cpu.mean, r.pairs, r.contact_points,
      1e3 * r.end.overlap.deepest, 1e3 * r.end.overlap.mean(), 1e3 * r.end.joint_gap, r.end.fastest,
      r.end.escaped);
  out += "          ";
  double rest = r.wall.mean;
  for (const StageMean& s : r.stages) {
    out += fmt::format("{} {:.3f}, ", s.name, s.milliseconds);
    rest -= s.milliseconds;
  }
  return out + fmt::format("rest {:.3f}; {:.0f} MB, {:.0f} bytes a body, {:.0f} a contact, {}\n",
                           rest, r.peak_memory, r.bytes_per_body(), r.bytes_per_contact(),
                           hash_text(r.state_hash));
}

std::string bench_json(std::span<const WorkloadRun> runs) {
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  for (const WorkloadRun& r : runs) results.push_back(json_of(r));
  return nlohmann::ordered_json{{"results", results}}.dump(2);
}

}  // namespace tumble
