#pragma once
#include "engine/world/microscope/microscope.hpp"

#include <optional>

namespace tumble {

/// The setup for a body and the nearest other body (by bounds) that some microscope accepts as a
/// pair. If there is none, or the body is null, the setup for a microscope that needs no second
/// body; empty if there is no such microscope either.
std::optional<MicroscopeSetup> find_microscope_pair(const Frame& frame, BodyId body);

}  // namespace tumble
