#pragma once
#include "engine/dynamics/particles/particle_system.hpp"

namespace tumble {

/// The particles of a system at one moment, as files tell of them. Index i of every array is the
/// same particle; ids ascend.
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

/// A system as it is.
ParticleSample sample_particles(const ParticleSystem& system);
/// Between two ticks of a system, `s` of the way from the first to the second: positions,
/// velocities and ages go straight from one to the other, in periodic boxes by the shortest way;
/// all else is the later one's. Who was born between the two is as at the end, and who died is
/// missing: as in pictures.
ParticleSample sample_particles(const ParticleSystem& from, const ParticleSystem& to, double s);

}  // namespace tumble
