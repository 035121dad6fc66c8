#pragma once
#include "engine/math/types.hpp"

#include <cstddef>

namespace tumble {

struct ParticleSystem;

/// Sums and means over all particles of a system, for plots and assertions; zeros where there are
/// none.
struct ParticleMeasures {
  size_t count = 0;
  Vec3 centre = Vec3::Zero();                    ///< of mass [m]
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< corners of the box about all centres [m]
  double speed = 0;                              ///< root mean square [m/s]
  double max_speed = 0;                          ///< [m/s]
  /// Two thirds of the mean kinetic energy of a particle relative to the motion of the centre of
  /// mass, that is Boltzmann's constant times the temperature [J]; in the reduced units of a
  /// Lennard-Jones potential this is the temperature.
  double temperature = 0;
  double pressure = 0;  ///< of a fluid, mean over its particles [Pa]
};

ParticleMeasures measure_particles(const ParticleSystem& system);

}  // namespace tumble
