#include "engine/scene/workloads/definitions.hpp"
#include "engine/scene/workloads/draws.hpp"
#include "engine/scene/workloads/parts.hpp"

namespace tumble {

/// W9: grains of 4.6 to 5 mm radius and 2600 kg/m3, each displaced by up to 0.2 mm along every
/// axis, collapse into a bed in a bin, and settle.
Workload grains_workload(bool small) {
  const int side = small ? 15 : 100, count = small ? 2000 : 100000;
  const double pitch = 0.0104;
  Workload w;
  w.steps = 60;
  add_bin(w, small ? 0.081 : 0.54, 2);
  ParticleSystemDef sand;
  sand.grains.emplace();
  WorkloadDraws draws(4242);
  for (int i = 0; i < count; ++i) {
    ParticleDef grain;
    grain.x = layered_place(i, side, pitch, 0.0055);
    for (int axis = 0; axis < 3; ++axis) grain.x[axis] += draws.between(-0.0002, 0.0002);
    grain.radius = draws.between(0.0046, 0.005);
    grain.mass = 2600 * 4.0 / 3.0 * det::pi * (grain.radius * grain.radius * grain.radius);
    sand.particles.push_back(grain);
  }
  w.particles.push_back(std::move(sand));
  return w;
}

}  // namespace tumble
