#pragma once
#include "engine/collision/particle_contacts/particle_contacts.hpp"

namespace tumble {

/// Errors in the particles; they name the index of the first one.
Status check_balls(const ParticleBalls& balls);
Status check_paths(const ParticlePaths& paths);
/// `name` must be at least 0, or greater if zero is not allowed.
Status check_length(const char* name, double value, bool zero_allowed);

}  // namespace tumble
