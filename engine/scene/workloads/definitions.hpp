#pragma once
#include "engine/scene/workloads/workload.hpp"

/// The definitions behind the registry, one file each.
namespace tumble {

Workload pyramid_workload(bool small);
Workload towers_workload(bool small);
Workload hulls_workload(bool small);
Workload spheres_workload(bool small);
Workload joint_grid_workload(bool small);
Workload ragdolls_workload(bool small);
Workload mesh_tori_workload(bool small);
Workload compound_tori_workload(bool small);
Workload washer_workload(bool small);
Workload grains_workload(bool small);

}  // namespace tumble
