#include "engine/scene/workloads/definitions.hpp"

namespace tumble {

const std::vector<WorkloadEntry>& all_workloads() {
  static const std::vector<WorkloadEntry> entries = {
      {"W1", "a pyramid of 820 cubes", pyramid_workload},
      {"W2", "a hundred towers of ten cubes", towers_workload},
      {"W3", "2000 convex hulls fall into a bin", hulls_workload},
      {"W4", "5000 balls rain into a bin", spheres_workload},
      {"W5", "a net of 900 balls and 1740 ball joints that hangs by its corners",
       joint_grid_workload},
      {"W6", "100 ragdolls of eleven bodies fall into a bin", ragdolls_workload},
      {"W7m", "200 tori on wavy ground, mesh against mesh", mesh_tori_workload},
      {"W7c", "the same tori, of twelve convex pieces each", compound_tori_workload},
      {"W8", "1000 cubes in a turning drum", washer_workload},
      {"W9", "100,000 grains of sand collapse into a bed", grains_workload},
  };
  return entries;
}

Workload make_workload(const WorkloadEntry& entry, bool small) {
  Workload w = entry.make(small);
  w.name = entry.name;
  w.small = small;
  for (BodyDef& b : w.bodies) b.can_sleep = false;
  return w;
}

}  // namespace tumble
