#pragma once
#include "engine/core/result.hpp"

#include <filesystem>

namespace tumble {

class World;

/// Writes the certificates of all contacts of the world as one JSON object, whole or not at all:
/// `contacts` (bodies by name, positions, gap, velocities, force, mode, place in the friction cone,
/// residuals, solver) and `bodies` (the balance of forces on each), SI units, world axes.
Status write_certificates(const World& world, const std::filesystem::path& file);

}  // namespace tumble
