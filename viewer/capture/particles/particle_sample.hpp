#pragma once
#include "engine/dynamics/particles/particle_system.hpp"

namespace tumble {

/// The particles of a system at one time, as written to files. Index i of every array is the same
/// particle; ids ascend.
struct ParticleSample {
  std::vector<Vec3> x;         ///< [m]
  std::vector<Vec3> v;         ///< [m/s]
  std::vector<double> radius;  ///< [m]
  std::vector<double> mass;    ///< [kg]
  std::vector<double> age;     ///< [s]
  std::vector<Vec3f> colour;   ///< linear RGB
  std::vector<uint64_t> id;

  size_t size() const { return x.size(); }
};

/// The present state of a system.
ParticleSample sample_particles(const ParticleSystem& system);
/// Interpolates between two ticks of a system at the fraction `s` of the way: positions, velocities
/// and ages linearly, in periodic boxes along the shortest way; all else is taken from the later
/// tick. A particle born between the two has its state at the later tick, and one that died is left
/// out, as in pictures.
ParticleSample sample_particles(const ParticleSystem& from, const ParticleSystem& to, double s);

}  // namespace tumble
