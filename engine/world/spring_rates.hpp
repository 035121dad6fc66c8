#pragma once
#include "engine/dynamics/forces/force.hpp"

#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// By body slot, blocks of particles included: a bound on how fast springs make it swing or creep
/// [1/s], the greater one of the root of its row sum in M^-1 K and of that in M^-1 C, with its
/// mobilities where springs hold it. By Gershgorin's theorem no net of springs has a rate above the
/// greatest of its nodes: an explicit integrator follows it with steps of a part of its inverse.
/// Links and bends of meshes count as springs; other forces as none.
std::vector<double> spring_rates(std::span<const std::optional<ForceDef>> forces,
                                 const ForceContext& context);

}  // namespace tumble
