// Molecular dynamics beside LAMMPS: the melt of its own benchmark, 32,000 Lennard-Jones atoms of
// density 0.8442 and temperature 1.44 with a cut-off of 2.5 and time steps of 0.005 (LAMMPS'
// manual, "lj" benchmark). Both start from the same places and velocities; the answer is the
// potential energy of an atom, which agrees until chaos has had its time (some hundred steps), and
// in the mean for ever.
#include "engine/world/world.hpp"
#include "tests/bench/contest.hpp"

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <lammps/library.h>

using namespace tumble;
using namespace tumble::bench;

namespace {

constexpr double cutoff = 2.5, time_step = 0.005;
constexpr int steps_of_a_round = 50;

/// LAMMPS on one core, with its plain or its `opt` styles.
class LammpsMelt {
 public:
  explicit LammpsMelt(const char* suffix) {
    std::string words[] = {"melt", "-screen", "none", "-log", "none", "-suffix", suffix};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    const int count = int(arguments.size()) - (*suffix ? 0 : 2);
    handle_ = lammps_open_no_mpi(count, arguments.data(), nullptr);
    if (!handle_) throw std::runtime_error("LAMMPS does not start");
    lammps_commands_string(handle_, R"(
      units lj
      atom_style atomic
      atom_modify map array
      lattice fcc 0.8442
      region box block 0 20 0 20 0 20
      create_box 1 box
      create_atoms 1 box
      mass 1 1.0
      velocity all create 1.44 87287 loop geom
      pair_style lj/cut 2.5
      pair_coeff 1 1 1.0 1.0 2.5
      neighbor 0.3 bin
      neigh_modify delay 0 every 20 check no
      fix 1 all nve
      timestep 0.005
      run 0
    )");
  }
  LammpsMelt(const LammpsMelt&) = delete;
  LammpsMelt& operator=(const LammpsMelt&) = delete;
  ~LammpsMelt() { lammps_close(handle_); }

  double run() {
    lammps_commands_string(handle_,
                           ("run " + std::to_string(steps_of_a_round) + " pre no post no").c_str());
    return lammps_get_thermo(handle_, "pe");
  }
  /// Places ("x") or velocities ("v") of all atoms.
  std::vector<Vec3> gather(std::string what) const {
    const auto n = size_t(lammps_get_natoms(handle_));
    std::vector<double> flat(3 * n);
    lammps_gather_atoms(handle_, what.data(), 1, 3, flat.data());
    std::vector<Vec3> out(n);
    for (size_t i = 0; i < n; ++i) out[i] = {flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]};
    return out;
  }
  Vec3 box() const {
    double low[3], high[3], tilt[3];
    int periodic[3], changes = 0;
    lammps_extract_box(handle_, low, high, tilt, tilt + 1, tilt + 2, periodic, &changes);
    return {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
  }

 private:
  void* handle_ = nullptr;
};

template <class T>
T checked(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().text());
  return std::move(*result);
}

/// The same atoms as a particle system of a world. Semi-implicit Euler is the leapfrog, with
/// velocities at the middles of the steps.
class WorldMelt {
 public:
  WorldMelt(const LammpsMelt& peer, int threads) {
    WorldDef def;
    def.threads = threads;
    def.settings.gravity = Vec3::Zero();
    def.settings.tick.num = int(1 / time_step);
    world_ = checked(World::create(std::move(def)));
    const std::vector<Vec3> x = peer.gather("x"), v = peer.gather("v");
    ParticleSystemDef atoms;
    atoms.collide = false;
    atoms.box.size = peer.box();
    for (size_t i = 0; i < x.size(); ++i) {
      ParticleDef p;
      p.x = x[i], p.v = v[i], p.mass = 1, p.radius = 0.5;
      atoms.particles.push_back(p);
    }
    atoms_ = x.size();
    checked(world_->create_particles(std::move(atoms)));
    LennardJonesDef law;
    law.epsilon = 1, law.sigma = 1, law.end.cutoff = cutoff;
    checked(world_->create_force(law));
  }
  double run() {
    for (int k = 0; k < steps_of_a_round; ++k) checked(world_->step());
    return world_->frame()->stats.energies.fields / double(atoms_);
  }

 private:
  std::unique_ptr<World> world_;
  size_t atoms_ = 0;
};

}  // namespace

int main() {
  LammpsMelt plain(""), optimised("opt");
  WorldMelt one(plain, 1), two(plain, 2);
  report("32,000 Lennard-Jones atoms, 50 steps",
         {{"LAMMPS lj/cut", [&] { return plain.run(); }},
          {"LAMMPS lj/cut/opt", [&] { return optimised.run(); }},
          {"Tumble, a thread", [&] { return one.run(); }},
          {"Tumble, two threads", [&] { return two.run(); }}},
         5);
}
