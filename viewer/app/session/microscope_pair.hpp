#pragma once
#include "engine/world/microscope/microscope.hpp"

#include <optional>

namespace tumble {

/// A body with the one nearest to it (by their bounds) that some microscope takes together with it;
/// where there is none, or with a null body, what some microscope takes without another; nothing
/// when there is no such microscope either.
std::optional<MicroscopeSetup> find_microscope_pair(const Frame& frame, BodyId body);

}  // namespace tumble
