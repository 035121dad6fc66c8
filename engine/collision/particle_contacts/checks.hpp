#pragma once
#include "engine/collision/particle_contacts/particle_contacts.hpp"

namespace tumble {

/// What is wrong with the particles, naming the first of them.
Status check_balls(const ParticleBalls& balls);
Status check_paths(const ParticlePaths& paths);
/// `name` must be at least 0, or above it.
Status check_length(const char* name, double value, bool zero_allowed);

}  // namespace tumble
