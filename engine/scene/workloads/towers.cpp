#include "engine/scene/workloads/definitions.hpp"
#include "engine/scene/workloads/parts.hpp"

namespace tumble {

/// W2: towers of ten unit cubes, 3 m apart.
Workload towers_workload(bool small) {
  const int side = small ? 3 : 10;
  const double middle = (side - 1) / 2.0;
  Workload w;
  w.steps = 300;
  w.bodies.push_back(wide_floor());
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < 10; ++k)
        w.bodies.push_back(
            box_body({(i - middle) * 3, k + 0.5, (j - middle) * 3}, Vec3::Constant(0.5)));
  return w;
}

}  // namespace tumble
