#pragma once
#include "engine/dynamics/particles/particle_system.hpp"
#include "engine/scene/description.hpp"

#include <map>
#include <string>
#include <vector>

namespace tumble {

class World;

/// Removes particles of a fluid that would start inside bodies, or nearer to them than a quarter of
/// their spacing, and reports how many. `bodies` are those of the world, whose commands have been
/// applied. Error, with a cure, for a fluid that would fall for ever: gravity acts on it, no body
/// is below or beside it, its particles have no end of life and no periodic box, and nothing such
/// as a sink removes it (`may_fall`).
Status fit_fluid(const World& world, const std::map<std::string, BodyId, std::less<>>& bodies,
                 ParticleSystemDef& def, bool may_fall, std::vector<std::string>& warnings);

}  // namespace tumble
