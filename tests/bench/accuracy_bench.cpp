// Errors of the accuracy cases A1 to A10 (tests/support/accuracy/cases.hpp) in Tumble's two
// steppers and in Bullet, ODE (QuickStep and its direct solver) and MuJoCo, with the processor time
// of each. `bench_accuracy [--hz 240] [CASE...]`; cases of minutes may be cut short with
// `--seconds`.
#include "tests/bench/accuracy/peers.hpp"
#include "tests/bench/contest.hpp"
#include "tests/support/accuracy/cases.hpp"
#include "tests/support/accuracy/tumble_case.hpp"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>

using namespace tumble;
using namespace tumble::test;

namespace {

struct Competitor {
  std::string name;
  CaseMaker maker;
  bool elastic = true;  ///< knows restitution
};

/// Figures of one engine, in the order of the case's rows.
using Figures = std::vector<double>;

struct AccuracyCase {
  std::string name;
  std::vector<std::string> rows;
  double seconds;
  bool elastic;
  std::function<Figures(const CaseMaker&, int hz, double seconds)> run;
};

CaseMaker ours(const char* stepper) {
  WorldSettings s;
  s.stepper = stepper;
  return tumble_maker(s, {[stepper](const std::string& m) {
                        if (m.find("once") != std::string::npos) return;  // news, no failure
                        throw std::runtime_error(std::string(stepper) + ": " + m);
                      }});
}

const Vec3 ahead(1, 0, 0), oblique(0.5, 0, std::sqrt(0.75)),
    diagonal(std::sqrt(0.5), 0, std::sqrt(0.5));

std::vector<AccuracyCase> all_cases() {
  const auto gas = [](bool gravity) {
    return [gravity](const CaseMaker& m, int hz, double s) {
      const GasErrors e = a3_gas(m, hz, gravity, s);
      return Figures{e.energy_end, e.energy_most, e.momentum};
    };
  };
  return {
      {"A1",
       {"slab, along x", "slab, at 60 degrees", "ball, at 60 degrees"},
       4,
       false,
       [](const CaseMaker& m, int hz, double s) {
         const RollingErrors x = a1_rolling(m, hz, ahead, s), d = a1_rolling(m, hz, oblique, s);
         return Figures{x.slab, d.slab, d.ball};
       }},
      {"A2",
       {"energy, end", "energy, most", "place [m]"},
       20,
       true,
       [](const CaseMaker& m, int hz, double s) {
         const BounceErrors e = a2_bounces(m, hz, s);
         return Figures{e.energy_end, e.energy_most, e.place};
       }},
      {"A3", {"energy, end", "energy, most"}, 10, true, gas(true)},
      {"A3z", {"energy, end", "energy, most", "momentum"}, 3, true, gas(false)},
      {"A4",
       {"velocity, touching", "velocity, 1 cm apart", "energy, touching"},
       3,
       true,
       [](const CaseMaker& m, int hz, double) {
         const CradleErrors touching = a4_cradle(m, hz, 0), apart = a4_cradle(m, hz, 0.01);
         return Figures{touching.velocity, apart.velocity, touching.energy};
       }},
      {"A5",
       {"energy, 10 s", "energy, end", "energy, most", "joints [m]"},
       60,
       false,
       [](const CaseMaker& m, int hz, double s) {
         const PendulumErrors e = a5_double_pendulum(m, hz, s);
         return Figures{e.energy_10s, e.energy_end, e.energy_most, e.joint};
       }},
      {"A6",
       {"angular momentum, most", "energy, most", "flips missing"},
       60,
       false,
       [](const CaseMaker& m, int hz, double s) {
         const HandleErrors e = a6_handle(m, hz, s);
         return Figures{e.momentum_most, e.energy_most, double(e.flips_wanted - e.flips)};
       }},
      {"A7",
       {"coefficient, along x", "coefficient, diagonal", "acceleration, along x",
        "acceleration, diagonal", "creep in 5 s, diagonal [m]"},
       5,
       false,
       [](const CaseMaker& m, int hz, double) {
         const FrictionErrors x = a7_friction(m, hz, ahead), d = a7_friction(m, hz, diagonal);
         return Figures{x.coefficient, d.coefficient, x.acceleration, d.acceleration, d.creep};
       }},
      {"A8",
       {"sinks, 1:100 [m]", "sinks, 1:1000 [m]", "speed, 1:1000 [m/s]"},
       10,
       false,
       [](const CaseMaker& m, int hz, double) {
         const SinkErrors light = a8_sink(m, hz, 100), heavy = a8_sink(m, hz, 1000);
         return Figures{light.most, heavy.most, heavy.speed};
       }},
      {"A9",
       {"moved, 1 s [m]", "moved, end [m]", "fallen of 40"},
       10,
       false,
       [](const CaseMaker& m, int hz, double s) {
         const CardErrors e = a9_cards(m, hz, s);
         return Figures{e.moved_1s, e.moved_end, double(e.fallen)};
       }},
      {"A10",
       {"overlap [m]"},
       3,
       false,
       [](const CaseMaker& m, int hz, double s) { return Figures{a10_penetration(m, hz, s)}; }},
  };
}

std::vector<Competitor> all_competitors() {
  return {{"event", ours("event")},
          {"realtime", ours("realtime")},
          {"Bullet", bullet_maker()},
          {"ODE quick", ode_maker(false)},
          {"ODE exact", ode_maker(true)},
          {"MuJoCo", mujoco_maker("Euler"), false},
          {"MuJoCo RK4", mujoco_maker("RK4"), false}};
}

void print_row(const std::string& name, const std::vector<Figures>& columns, size_t row) {
  fmt::print("  {:<28}", name);
  for (const Figures& f : columns)
    fmt::print("{:>12}", row < f.size() ? fmt::format("{:.3g}", f[row]) : "-");
  fmt::print("\n");
}

void run_case(const AccuracyCase& c, const std::vector<Competitor>& competitors, int hz,
              double seconds) {
  std::vector<Figures> columns, times;
  for (const Competitor& who : competitors) {
    Figures figures;
    const double start = bench::processor_milliseconds();
    try {
      if (who.elastic || !c.elastic) figures = c.run(who.maker, hz, seconds);
    } catch (const std::runtime_error& e) {
      fmt::print(stderr, "{}: {}: {}\n", c.name, who.name, e.what());
    }
    times.push_back({});
    if (!figures.empty()) times.back() = {1e-3 * (bench::processor_milliseconds() - start)};
    columns.push_back(figures);
  }
  fmt::print("{}, {} Hz, {:g} s\n", c.name, hz, seconds);
  for (size_t row = 0; row < c.rows.size(); ++row) print_row(c.rows[row], columns, row);
  print_row("processor time [s]", times, 0);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  int hz = 60;
  double most = 1e9;
  std::vector<std::string> wanted;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--hz" && i + 1 < count)
      hz = std::atoi(words[++i]);
    else if (word == "--seconds" && i + 1 < count)
      most = std::atof(words[++i]);
    else
      wanted.push_back(word);
  }
  const std::vector<Competitor> competitors = all_competitors();
  fmt::print("{:<30}", "errors");
  for (const Competitor& c : competitors) fmt::print("{:>12}", c.name);
  fmt::print("\n");
  for (const AccuracyCase& c : all_cases())
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), c.name) != wanted.end())
      run_case(c, competitors, hz, std::min(most, c.seconds));
}
