#pragma once
#include "engine/dynamics/particles/particle_system.hpp"
#include "engine/scene/description.hpp"

#include <map>
#include <string>
#include <vector>

namespace tumble {

class World;

/// Takes the particles out of a fluid that would begin in bodies, or nearer to them than a quarter
/// of their spacing, and says how many. `bodies` are those of the world, which has applied its
/// commands. The error of a fluid that would fall for ever says how to hold it: no body is below or
/// beside it, gravity pulls it, its particles have no end of life and no periodic box, and it may
/// not fall (`may_fall`: something takes it away, such as a sink).
Status fit_fluid(const World& world, const std::map<std::string, BodyId, std::less<>>& bodies,
                 ParticleSystemDef& def, bool may_fall, std::vector<std::string>& warnings);

}  // namespace tumble
