#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/world/settings.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// How world B is drawn: as a ghost in the picture of A, in a picture of its own beside it, or not.
enum class ComparedAs : uint8_t { ghost, beside, hidden };

/// World A, which is shown, beside world B, which differs in settings: what panels show of it.
struct WorldComparison {
  WorldSettings settings;              ///< of B
  std::vector<double> times;           ///< of the latest moments that both have [s]
  std::vector<float> distances;        ///< greatest, then, of bodies and particles [m]
  double distance = 0, angle = 0;      ///< now [m], [rad]
  double worst = 0;                    ///< greatest so far [m]
  std::string what;                    ///< where it is greatest now; "": nowhere
  std::optional<uint64_t> first_tick;  ///< of A, from which on they differ; none: they do not
  std::string first_what;              ///< what differed first
  BodyId first_body;                   ///< null when that is no body, or gone
  std::string fault;                   ///< why B has stopped; "": it has not
};

}  // namespace tumble
