#include "engine/scene/workloads/definitions.hpp"
#include "engine/scene/workloads/parts.hpp"

namespace tumble {

/// W1: rows of unit cubes, one fewer in each, with gaps of 0.05 m.
Workload pyramid_workload(bool small) {
  const int base = small ? 12 : 40;
  Workload w;
  w.steps = 300;
  w.bodies.push_back(wide_floor());
  for (int row = 0; row < base; ++row)
    for (int k = 0; k < base - row; ++k)
      w.bodies.push_back(
          box_body({(k - (base - 1 - row) / 2.0) * 1.05, row + 0.5, 0}, Vec3::Constant(0.5)));
  return w;
}

}  // namespace tumble
