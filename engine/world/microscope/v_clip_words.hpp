#pragma once
#include "engine/collision/polyhedron_feature.hpp"
#include "engine/world/microscope/sketch.hpp"

#include <optional>
#include <string>

namespace tumble {

/// "vertex 3 of A"; `body` 0 is A.
std::string feature_text(const PolyhedronFeature& feature, size_t body);
/// "V-E": the state of a pair, as the diagram of v_clip.hpp names it (the lesser feature first).
std::string state_text(const ClosestFeatures& at);

/// A step of the walk: a feature of one body is replaced by a neighbour.
struct VClipMove {
  int number = 0;        ///< number of the transition in the diagram of v_clip.hpp
  size_t body = 0;       ///< whose feature changes; 0 is A
  std::string sentence;  ///< why, in plain words
};
/// Empty when the pair stays the same.
std::optional<VClipMove> v_clip_move(const ClosestFeatures& from, const ClosestFeatures& to);

/// The diagram of states, with that of `at` highlighted, and the transition to `next`.
Diagram v_clip_diagram(const ClosestFeatures& at, const std::optional<ClosestFeatures>& next,
                       bool penetrating);

}  // namespace tumble
