#include "engine/scene/workloads/definitions.hpp"
#include "engine/scene/workloads/draws.hpp"
#include "engine/scene/workloads/parts.hpp"

namespace tumble {

/// W4: layers of balls, each displaced by up to 2 cm along every axis, fall into a bin.
Workload spheres_workload(bool small) {
  const int side = small ? 5 : 16, count = small ? 250 : 5000;
  Workload w;
  w.steps = 600;
  add_bin(w, 0.3125 * side, 30);
  WorkloadDraws draws(777);
  for (int i = 0; i < count; ++i) {
    Vec3 x = layered_place(i, side, 0.6, 0.5);
    for (int axis = 0; axis < 3; ++axis) x[axis] += draws.between(-0.02, 0.02);
    w.bodies.push_back(sphere_body(x, 0.25));
  }
  return w;
}

}  // namespace tumble
