// The dam break of a tank of 4 x 3 x 1 m with a column of 1 x 1.6 x 1 m, for which SPlisHSPlasH
// (no Debian package) makes 251,000 to 274,000 particle-steps a second by its DFSPH and 477,000 to
// 492,000 by its WCSPH, on one thread of a machine of this kind.
//   bench_fluid [--spacing M] [--seconds S] [--threads N] [dfsph|wcsph ...]
#include "engine/core/crew.hpp"
#include "tests/bench/contest.hpp"
#include "tests/dynamics/fluid_tank.hpp"

#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace tumble;

struct FluidRun {
  double spacing = 0.025, seconds = 0.25;
  int threads = 1;
};

void run(const FluidSolverName& solver, const FluidRun& options) {
  FluidTank tank;
  tank.def.solver = solver.kind;
  tank.def.viscosity = 0.01;
  tank.add_walls({4, 3, 1});
  tank.fill(Vec3::Zero(), {1, 1.6, 1}, options.spacing);
  Crew crew(options.threads);
  tank.crew = &crew;
  double sub_steps = 0, pressure = 0, shift = 0;
  const double start = bench::processor_milliseconds();
  const auto wall_start = std::chrono::steady_clock::now();
  for (double t = 0; t < options.seconds; t += tank.h) {
    if (!tank.step()) {
      std::printf("%s: a step failed\n", solver.name.data());
      std::exit(1);
    }
    sub_steps += tank.last.sub_steps;
    pressure += tank.last.pressure_iterations;
    shift += tank.last.shift_iterations;
  }
  const double cpu = 1e-3 * (bench::processor_milliseconds() - start);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_start;
  const double steps = sub_steps * double(tank.x.size());
  double height = 0, front = 0;
  for (const Vec3& x : tank.x)
    height += x[1] / double(tank.x.size()), front = std::max(front, x[0]);
  std::printf(
      "%s: %zu particles, %.0f sub-steps, %.0f thousand particle-steps a second (%.0f a second of "
      "processor time), iterations %.2f + %.2f, pairs %.1f, density error %.3f %%, mean height "
      "%.4f m, front %.3f m\n",
      solver.name.data(), tank.x.size(), sub_steps, 1e-3 * steps / wall.count(), 1e-3 * steps / cpu,
      pressure / sub_steps, shift / sub_steps, double(tank.last.pairs) / double(tank.x.size()),
      100 * tank.last.density_error, height, front);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  FluidRun options;
  std::vector<std::string> names;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--spacing" && k + 1 < argc)
      options.spacing = std::atof(argv[++k]);
    else if (word == "--seconds" && k + 1 < argc)
      options.seconds = std::atof(argv[++k]);
    else if (word == "--threads" && k + 1 < argc)
      options.threads = std::atoi(argv[++k]);
    else
      names.push_back(word);
  }
  for (const FluidSolverName& solver : all_fluid_solvers())
    if (names.empty() || std::find(names.begin(), names.end(), solver.name) != names.end())
      run(solver, options);
}
