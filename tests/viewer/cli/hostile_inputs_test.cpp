// Every file of tests/inputs, which once froze the program, filled its memory, exploded or wrote
// nan, through the real program. References: the exit codes of the README, the place where the
// fault was put into the file, energy that nothing can add, and limits of processor time and
// memory that the kernel holds.
#include "tests/support/process_limits.hpp"
#include "tests/support/scale.hpp"
#include "tests/viewer/cli/program.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

namespace fs = std::filesystem;

const fs::path inputs = fs::path(TUMBLE_SOURCE_DIR) / "tests/inputs";

std::string input(const std::string& name) {
  return (inputs / name).string();
}

ProgramRun limited(const std::vector<std::string>& arguments, unsigned cpu_seconds,
                   unsigned megabytes = 1024) {
  ProgramOptions options;
  options.cpu_seconds = test::only_to_run() ? 10 * cpu_seconds : cpu_seconds;
  options.megabytes = megabytes;
  options.timeout = 600;
  return tumble_program(arguments, options);
}

/// The command says no, with exit code 3, where the fault is and what would be right.
void check_refused(const std::string& name, const std::string& place, const std::string& cure) {
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"check", input(name)}, {"simulate", input(name), "--steps", "1"}}) {
    const ProgramRun run = limited(command, 5, 512);
    CHECK_MESSAGE(run.code == 3, command[0] << ": " << run.err);
    CHECK_MESSAGE(mentions(run.err, name + place), run.err);
    CHECK_MESSAGE(mentions(run.err, cure), run.err);
  }
}

/// What a run wrote, a row a tick.
struct Rows {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;

  std::vector<double> column(const std::string& name) const {
    const auto at = std::find(names.begin(), names.end(), name);
    REQUIRE(at != names.end());
    std::vector<double> out;
    for (const auto& row : values) out.push_back(row[size_t(at - names.begin())]);
    return out;
  }
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

Rows read_rows(const fs::path& csv) {
  Rows rows;
  std::ifstream in(csv);
  std::string line;
  std::getline(in, line);
  rows.names = cells_of(line);
  while (std::getline(in, line)) {
    rows.values.emplace_back();
    for (const std::string& cell : cells_of(line)) rows.values.back().push_back(std::stod(cell));
    REQUIRE(rows.values.back().size() == rows.names.size());
  }
  return rows;
}

/// Runs a scene for some ticks within the limits; every number that it writes is finite.
Rows run_finite(const std::string& name, int ticks, unsigned cpu_seconds,
                unsigned megabytes = 1024) {
  const TempFolder folder;
  const fs::path csv = folder / "out.csv";
  const ProgramRun run = limited({"simulate", input(name), "--steps", std::to_string(ticks),
                                  "--threads", "2", "--csv", csv.string()},
                                 cpu_seconds, megabytes);
  CHECK_MESSAGE(run.code == 0, run.err);
  const Rows rows = read_rows(csv);
  CHECK(rows.values.size() == size_t(ticks) + 1);
  for (const auto& row : rows.values)
    for (size_t i = 0; i < row.size(); ++i)
      CHECK_MESSAGE(std::isfinite(row[i]), rows.names[i] << " = " << row[i]);
  return rows;
}

/// Nothing drives the scene: energy never exceeds what it began with, but for `slack` of it.
void check_no_energy_added(const Rows& rows, double slack) {
  const std::vector<double> total = rows.column("total_J");
  for (const double energy : total) CHECK(energy <= total[0] + slack * std::fabs(total[0]));
}

/// All ticks when all counts are asked for, as many as take some seconds otherwise.
int ticks(int full, int gate) {
  return test::all_counts() ? full : std::min(full, test::only_to_run() ? 3 : gate);
}

}  // namespace

TEST_CASE("every file of tests/inputs has a case in this file") {
  std::ifstream in(fs::path(TUMBLE_SOURCE_DIR) / "tests/viewer/cli/hostile_inputs_test.cpp");
  std::ostringstream text;
  text << in.rdbuf();
  size_t files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(inputs)) {
    ++files;
    const std::string name = entry.path().filename().string();
    CHECK_MESSAGE(mentions(text.str(), "TEST_CASE(\"" + name + ": "), name);
  }
  CHECK(files >= 15);
}

TEST_CASE("big_lever.json: a body with a shape 100 km from its others is named and runs") {
  const ProgramRun check = limited({"check", input("big_lever.json")}, 5, 512);
  CHECK(check.code == 0);
  CHECK_MESSAGE(mentions(check.err, "big_lever.json: warning: bodies.box"), check.err);
  CHECK_MESSAGE(mentions(check.err, "lengths are in metres"), check.err);
  run_finite("big_lever.json", 120, 10, 512);
}

TEST_CASE("collinear.obj: a point in the middle of an edge leaves the tetrahedron closed") {
  const ProgramRun run = limited({"mesh", input("collinear.obj")}, 5, 512);
  CHECK(run.code == 0);
  CHECK_MESSAGE(mentions(run.out, "closed; Euler characteristic 2"), run.out);
  CHECK_MESSAGE(mentions(run.out, "1.33333333"), run.out);  // 2^3 / 6
  CHECK_MESSAGE(mentions(run.out, "faults          none"), run.out);
}

TEST_CASE("collinear_needle.obj: the point moved by 1e-7 is a needle, which a weld cures") {
  const ProgramRun run = limited({"mesh", input("collinear_needle.obj")}, 5, 512);
  CHECK(run.code == 0);
  CHECK_MESSAGE(mentions(run.out, "needle at most 1e-07 m high"), run.out);
  CHECK_MESSAGE(mentions(run.out, "weld within 2e-07 m"), run.out);
  CHECK_FALSE(mentions(run.out, "intersect"));
  const ProgramRun welded =
      limited({"mesh", input("collinear_needle.obj"), "--weld", "2e-7"}, 5, 512);
  CHECK(welded.code == 0);
  CHECK_MESSAGE(mentions(welded.out, "faults          none"), welded.out);
}

TEST_CASE("event_too_long.json: ticks of the event stepper in a box of moving bodies end") {
  run_finite("event_too_long.json", 60, 20, 512);
}

TEST_CASE("inf_point_gravity_1e300.json: a field beyond all measure is refused where it stands") {
  check_refused("inf_point_gravity_1e300.json", ":30: forces.f.mu: ", "<= 1e+21 m3/s2");
}

TEST_CASE("nan_gravity_1e300.json: gravity beyond all measure is refused where it stands") {
  check_refused("nan_gravity_1e300.json", ":6: settings.gravity[1]: ", ">= -1000000000");
}

TEST_CASE("particle_radius_1e-9.json: what check refuses and what simulate refuses is the same") {
  check_refused("particle_radius_1e-9.json", ":1: particles.du.radius: ", "at least 1e-06 m");
}

TEST_CASE("ply_named.gltf: a damaged PLY under another name is refused at once") {
  const ProgramRun run = limited({"mesh", input("ply_named.gltf")}, 5, 512);
  CHECK(run.code == 3);
  CHECK_MESSAGE(mentions(run.err, "ply_named.gltf: is no glTF file"), run.err);
  CHECK_MESSAGE(mentions(run.err, "(files are read by the ending"), run.err);
  CHECK(run.out.empty());
}

TEST_CASE("pulled_column.json: a column out of which a block is pulled, every tick ends") {
  run_finite("pulled_column.json", ticks(300, 60), 60, 512);
}

TEST_CASE("readme_dust.json: the ball of dust of the README keeps its energy") {
  // It had 1e18 J after .7 s: 42 ticks.
  check_no_energy_added(run_finite("readme_dust.json", ticks(60, 10), 120), 1e-3);
}

TEST_CASE("same_spot.json: 3000 spheres in one spot are refused before memory is taken") {
  const TempFolder folder;
  const fs::path csv = folder / "out.csv";
  const ProgramRun run = limited(
      {"simulate", input("same_spot.json"), "--steps", "10", "--csv", csv.string()}, 20, 512);
  CHECK(run.code == 6);
  CHECK_MESSAGE(mentions(run.err, "tick 1, about body 'a["), run.err);
  CHECK_MESSAGE(mentions(run.err, "(place them apart)"), run.err);
  for (const auto& row : read_rows(csv).values)
    for (const double value : row) CHECK(std::isfinite(value));
}

TEST_CASE("springs_nan_exit0.json: a net of light particles and stiff springs stays finite") {
  // 9 mJ at the start. The springs are so stiff (h omega = 30) and turn so far in the first tick
  // that one linear solve stretches them, up to .9 J; the next ticks take that away again.
  const std::vector<double> total =
      run_finite("springs_nan_exit0.json", 300, 20, 512).column("total_J");
  for (size_t i = 0; i < total.size(); ++i) CHECK(total[i] < (i < 6 ? 1 : total[0]));
}

TEST_CASE("springs_reach_10000.json: springs are counted before they are made") {
  check_refused("springs_reach_10000.json",
                ":22: particles.p.springs: ", "(a shorter reach makes fewer)");
}

TEST_CASE("stiff_cloth.json: a stiff cloth loses energy as it falls on a ball") {
  check_no_energy_added(run_finite("stiff_cloth.json", ticks(120, 48), 30), 1e-3);
}

TEST_CASE("wrong_length.json: a joint that does not fit is named and corrected at bounded speed") {
  const ProgramRun check = limited({"check", input("wrong_length.json")}, 5, 512);
  CHECK(check.code == 0);
  CHECK_MESSAGE(mentions(check.err, "wrong_length.json: warning: joints.j: length is 1e+06 m"),
                check.err);
  CHECK_MESSAGE(mentions(check.err, "(leave out length, or place the bodies to fit)"), check.err);
  run_finite("wrong_length.json", 60, 10, 512);
  // They were 2 m apart, and thrown 500 km. At push_out_speed, 3 m/s, each gets 3 m at most.
  const ProgramRun run =
      limited({"simulate", input("wrong_length.json"), "--seconds", "1", "--assert",
               "bodies.a.position.x > -3.1 && bodies.b.position.x < 5.1", "--assert",
               "bodies.a.position.x > -10 && bodies.b.position.x > 2"},
              10, 512);
  CHECK_MESSAGE(run.code == 0, run.err);
}

TEST_CASE("memory that does not suffice is 7, in a sentence of its own, from every thread") {
  if (!limits_memory) return;
  for (const char* threads : {"1", "4"}) {
    for (const unsigned megabytes : {80u, 128u}) {
      const ProgramRun run =
          limited({"simulate", input("readme_dust.json"), "--steps", "4", "--threads", threads}, 60,
                  megabytes);
      CAPTURE(megabytes);
      CHECK_MESSAGE(run.code == 7, run.err);
      CHECK_MESSAGE(mentions(run.err, "tumble: there is not enough memory for this (use fewer"),
                    run.err);
      CHECK(run.out.empty());
    }
  }
  CHECK(mentions(tumble_program({"--help"}).out, "7 not enough memory"));
}
