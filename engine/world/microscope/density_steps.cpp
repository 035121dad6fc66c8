#include "engine/world/microscope/density_steps.hpp"

#include "engine/dynamics/particles/fluid_def.hpp"
#include "engine/world/microscope/chart.hpp"
#include "engine/world/microscope/tolerances.hpp"
#include "engine/world/microscope/world_copy.hpp"
#include "engine/world/tick_watch.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr double percent = 100;

/// The first particle system that the setup asks for and that satisfies `good`.
template <class Good>
const ParticleFrame* first_of(const Frame& frame, const MicroscopeSetup& setup, const Good& good) {
  for (const auto& p : frame.particles)
    if (p && !p->x.empty() && (setup.particles.is_null() || p->id == setup.particles) && good(*p))
      return p.get();
  return nullptr;
}

/// The error that all but a few particles are below [%]: the upper end of the colours.
double colour_top(const FluidTrace::Solve& solve) {
  std::vector<float> wrong = solve.iterations.front().wrong;
  if (wrong.empty()) return 1;
  const auto at =
      wrong.begin() + ptrdiff_t((1 - tolerances::beyond_colours) * double(wrong.size() - 1));
  std::nth_element(wrong.begin(), at, wrong.end());
  return std::max(percent * double(*at), percent* solve.enough);
}

class DensityRecorder {
 public:
  /// Moves the numbers of the particles out of the trace, which may have hundreds of megabytes.
  DensityRecorder(const ParticleFrame& fluid, FluidTrace& trace) : fluid_(fluid), trace_(trace) {}

  MicroscopeRecording run() {
    out_.title = "DFSPH: pressures by iteration";
    add_solve(trace_.pressure, false);
    add_solve(trace_.shift, true);
    out_.answer = trace_.shift.iterations.back().error;
    return std::move(out_);
  }

 private:
  void add_solve(FluidTrace::Solve& solve, bool shift);
  void draw_plot(bool shift, size_t until, Diagram& out) const;
  std::string caption(const FluidTrace::Solve& solve, bool shift, size_t i) const;

  const ParticleFrame& fluid_;
  FluidTrace& trace_;
  MicroscopeRecording out_;
};

/// Plots the errors on a logarithmic scale: first those of the solve for velocities, then those of
/// the solve for positions.
void DensityRecorder::draw_plot(bool shift, size_t until, Diagram& out) const {
  out.title = "mean error, log scale";
  const double enough = std::min(trace_.pressure.enough, trace_.shift.enough);
  const double least =
      std::max(tolerances::least_plotted_error, tolerances::least_of_enough * enough);
  const auto height = [least](double error) { return std::log10(std::max(error, least)); };
  double top = -12, low = 0;
  size_t longest = 5;
  for (const FluidTrace::Solve* s : {&trace_.pressure, &trace_.shift}) {
    if (!s->iterations.empty())
      longest = std::max(longest, size_t(s->iterations.back().number) + 1);
    low = std::min(low, height(s->enough));
    for (const auto& i : s->iterations) {
      top = std::max(top, height(i.error));
      low = std::min(low, height(i.error));
    }
  }
  low = std::floor(low), top = std::max(std::ceil(top), low + 1);
  Chart chart(out, 0, double(longest - 1), low, top, "iteration", "");
  for (double power = low; power <= top; power += 1) {
    chart.line({0, power}, {double(longest - 1), power}, Ink::faint, 0.7f);
    out.labels.push_back({chart.at(double(longest - 1), power),
                          fmt::format("{:g} %", percent * std::pow(10, power)),
                          Ink::plain,
                          {1, 0}});
  }
  const auto draw = [&](const FluidTrace::Solve& s, size_t shown, Ink ink) {
    std::vector<Vec2> points;
    for (size_t i = 0; i < s.iterations.size() && i <= shown; ++i)
      points.push_back({double(s.iterations[i].number), height(s.iterations[i].error)});
    chart.line({0, height(s.enough)}, {double(longest - 1), height(s.enough)}, ink, 1);
    chart.curve(points, ink, 2.5f);
    if (!points.empty()) chart.point(points.back(), ink, 8);
  };
  draw(trace_.pressure, shift ? trace_.pressure.iterations.size() : until, Ink::first);
  if (shift) draw(trace_.shift, until, Ink::second);
}

std::string DensityRecorder::caption(const FluidTrace::Solve& solve, bool shift, size_t i) const {
  const double error = percent * solve.iterations[i].error, enough = percent * solve.enough;
  if (i == 0)
    return shift ? fmt::format(
                       "Velocities are right now, but their sub-step left some density "
                       "wrong: pressures that move places, and no velocities, are sought. "
                       "The mean error is {:.3g} %, and {:.3g} % will do.",
                       error, enough)
                 : fmt::format(
                       "The last sub-step of the coming tick, of {:.3g} s. With these "
                       "velocities the density would be wrong by {:.3g} % in the mean; "
                       "pressures are sought that leave {:.3g} %. They begin as they were.",
                       trace_.h, error, enough);
  if (i + 1 == solve.iterations.size())
    return fmt::format("{} iterations have brought the mean error to {:.3g} %; {:.3g} % {}.",
                       solve.iterations[i].number, error, enough,
                       error <= enough ? "were asked for"
                                       : "were asked for, but the limit of "
                                         "iterations came first");
  return fmt::format(
      "Each particle's pressure goes along its own error, over how much that "
      "pressure opens it, from that mixture of the last pressures which leaves the "
      "shortest way to go (Anderson). Bodies yield. The mean error is {:.3g} %.",
      error);
}

void DensityRecorder::add_solve(FluidTrace::Solve& solve, bool shift) {
  if (solve.iterations.empty()) return;
  const double top = colour_top(solve);
  for (size_t i = 0; i < solve.iterations.size(); ++i) {
    FluidTrace::Iteration& now = solve.iterations[i];
    MicroscopeStep& step = out_.steps.emplace_back();
    step.title = fmt::format("{}: iteration {}", shift ? "Places" : "Velocities", now.number);
    step.caption = caption(solve, shift, i);
    const float worst = *std::max_element(now.wrong.begin(), now.wrong.end());
    const auto off = std::count_if(now.wrong.begin(), now.wrong.end(),
                                   [&](float w) { return double(w) > solve.enough; });
    step.numbers = {{"sub-step", fmt::format("{} of {:.3g} s", trace_.sub_step, trace_.h)},
                    {"mean error", fmt::format("{:.4g} %", percent * now.error)},
                    {"asked for", fmt::format("{:.4g} %", percent * solve.enough)},
                    {"worst particle", fmt::format("{:.3g} %", percent * double(worst))},
                    {"particles above it", fmt::format("{} of {}", off, now.wrong.size())}};
    ParticleColours& colours = step.particles.emplace();
    colours.system = fluid_.id;
    colours.title = "density error", colours.unit = "%";
    colours.low = 0, colours.high = top;
    colours.value = std::move(now.wrong);
    for (float& w : colours.value) w *= float(percent);
    draw_plot(shift, i, step.diagram);
  }
}

}  // namespace

std::string refuse_density(const Frame& frame, const MicroscopeSetup& setup) {
  // A frame does not tell whether they are a fluid; the world does.
  const auto any = [](const ParticleFrame&) { return true; };
  return first_of(frame, setup, any) ? "" : "there are no particles here";
}

Result<MicroscopeRecording> record_density(const World& world, const MicroscopeSetup& setup) {
  const auto frame = world.frame();
  const auto is_dfsph = [&](const ParticleFrame& p) {
    const ParticleSystem* system = world.particles(p.id);
    return system && system->fluid && system->fluid->solver == FluidSolverKind::dfsph;
  };
  const ParticleFrame* found = first_of(*frame, setup, is_dfsph);
  if (!found)
    return Error{ErrorCode::not_found, "there is no fluid here whose solver is dfsph", {}, {}};
  const ParticleFrame& fluid = *found;
  auto copy = copy_of(world);
  if (!copy) return copy.error();
  TickWatch watch;
  watch.fluid = fluid.id;
  (*copy)->watch_with(&watch);
  if (auto stepped = (*copy)->step(); !stepped) return stepped.error();
  FluidTrace& trace = watch.pressures;
  if (trace.pressure.iterations.empty() || trace.shift.iterations.empty())
    return Error{ErrorCode::not_found, "no pressures were sought in the coming tick", {}, {}};
  return DensityRecorder(fluid, trace).run();
}

}  // namespace tumble
