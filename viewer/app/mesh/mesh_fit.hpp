#pragma once
#include "engine/collision/fitting/fit_primitive.hpp"

#include <string>
#include <variant>
#include <vector>

namespace tumble {

class StopSignal;

/// The primitives that approximate a mesh, best first.
struct FitFacts {
  std::vector<FittedPrimitive> fits;
  double seconds = 0;
};

/// Fits all kinds of primitives with progress on stderr, or takes them from the cache. After a
/// signal the error is `cancelled`.
Result<FitFacts> fit_mesh(const std::shared_ptr<const TriangleMesh>& mesh, const StopSignal& stop);

std::string fit_text(const FitFacts& facts);

}  // namespace tumble
