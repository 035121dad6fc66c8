#include "viewer/app/simulate/convergence.hpp"

#include "engine/math/rotation.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

using FramePtr = std::shared_ptr<const Frame>;

Result<FramePtr> run_at(const SceneRequest& request, uint64_t ticks, int finer,
                        const StopFlag* stop) {
  auto scene = load_scene_and_world(request);
  if (!scene) return scene.error();
  World& world = *scene->built.world;
  world.stop_with(stop);
  WorldSettings settings = world.settings();
  settings.tick.num *= finer;
  if (Status s = world.set_settings(settings); !s) return s.error();
  for (uint64_t i = 0; i < ticks * uint64_t(finer); ++i)
    if (const auto step = world.step(); !step) return step.error();
  return world.frame();
}

bool is_dynamic(const Frame& frame, size_t slot) {
  return !frame.body(slot).id.is_null() && frame.info(slot).type == BodyType::dynamic;
}

double position_difference(const Frame& a, const Frame& b) {
  double most = 0;
  for (size_t i = 0; i < a.body_slots(); ++i)
    if (is_dynamic(a, i)) most = std::max(most, (a.body(i).pose.x - b.body(i).pose.x).norm());
  for (size_t k = 0; k < a.particles.size(); ++k)
    for (size_t i = 0; i < a.particles[k]->x.size(); ++i)
      most = std::max(most, (a.particles[k]->x[i] - b.particles[k]->x[i]).norm());
  return most;
}

double orientation_difference(const Frame& a, const Frame& b) {
  double most = 0;
  for (size_t i = 0; i < a.body_slots(); ++i)
    if (is_dynamic(a, i)) most = std::max(most, a.body(i).pose.q.angularDistance(b.body(i).pose.q));
  return most;
}

double velocity_difference(const Frame& a, const Frame& b) {
  double most = 0;
  for (size_t i = 0; i < a.body_slots(); ++i)
    if (is_dynamic(a, i)) most = std::max(most, (a.body(i).v - b.body(i).v).norm());
  return most;
}

double energy_difference(const Frame& a, const Frame& b) {
  return std::fabs(a.stats.energies.total() - b.stats.energies.total());
}

/// log2(coarse / fine), if both are above rounding.
std::optional<double> observed_order(double coarse, double fine, double rounding) {
  if (!(coarse > rounding) || !(fine > rounding)) return std::nullopt;
  return std::log2(coarse / fine);
}

/// With value(h) = exact + C h^p, the differences are C h^p (1 - 2^-p), and that divided by 2^p.
void estimate_errors(ConvergenceRow& row) {
  if (!row.order || !(*row.order > 0.05)) {
    row.error = {row.difference[0], row.difference[1], row.difference[1]};
    return;
  }
  const double shrink = std::exp2(*row.order);
  row.error[2] = row.difference[1] / (shrink - 1);
  row.error[1] = row.error[2] * shrink;
  row.error[0] = row.error[1] * shrink;
}

}  // namespace

Result<ConvergenceReport> measure_convergence(const SceneRequest& request, uint64_t ticks,
                                              const StopFlag* stop) {
  const Stoppable scope(stop);
  std::array<FramePtr, 3> run;
  for (size_t i = 0; i < 3; ++i) {
    auto frame = run_at(request, ticks, 1 << i, stop);
    if (!frame) return frame.error();
    run[i] = *frame;
  }
  ConvergenceReport out;
  out.seconds = run[0]->time;
  for (size_t i = 0; i < 3; ++i) {
    out.tick[i] = run[i]->rate.tick();
    out.drift[i] = run[i]->ledger->drift();
  }
  out.drift_order = observed_order(out.drift[1], out.drift[2], 1e-15);
  double reach = 0;
  for (size_t i = 0; i < run[2]->body_slots(); ++i)
    if (is_dynamic(*run[2], i)) reach = std::max(reach, run[2]->body(i).pose.x.norm());
  const double energy = std::fabs(run[2]->stats.energies.total()) + run[2]->stats.energies.kinetic;
  const auto add = [&](const char* name, const char* unit, double scale, auto difference) {
    ConvergenceRow row{
        name, unit, {difference(*run[0], *run[1]), difference(*run[1], *run[2])}, std::nullopt, {}};
    row.order = observed_order(row.difference[0], row.difference[1], 1e-14 * scale);
    estimate_errors(row);
    out.rows.push_back(std::move(row));
  };
  add("position", "m", 1 + reach, position_difference);
  add("orientation", "rad", 1e6, orientation_difference);  // 1e-8: arc cosine near 1
  add("velocity", "m/s", 1, velocity_difference);
  add("energy", "J", 1e3 * (1 + energy), energy_difference);  // sum of many rounding errors
  return out;
}

std::string convergence_text(const ConvergenceReport& report) {
  std::string out = fmt::format("errors after {:.6g} s, estimated by Richardson\n{:<20}",
                                report.seconds, "tick [s]");
  for (const double h : report.tick) out += fmt::format("{:>13.6g}", h);
  out += "    order\n";
  const auto line = [&out](const std::string& name, const std::array<double, 3>& values,
                           const std::optional<double>& order) {
    out += fmt::format("{:<20}", name);
    for (const double v : values) out += fmt::format("{:>13.3e}", v);
    out += order ? fmt::format("{:>9.2f}\n", *order) : std::string("    exact\n");
  };
  for (const ConvergenceRow& row : report.rows)
    line(row.name + " [" + row.unit + "]", row.error, row.order);
  line("ledger drift [-]", report.drift, report.drift_order);
  return out;
}

}  // namespace tumble
