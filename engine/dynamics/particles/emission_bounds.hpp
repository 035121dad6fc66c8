#pragma once
#include "engine/dynamics/particles/emitter.hpp"

#include <span>
#include <vector>

namespace tumble {

/// An emitter and its name among the others.
struct NamedEmitter {
  EmitterId id;
  const EmitterDef* def;
};

/// How many of each emitter's own there may be at once, infinite where nothing bounds it: what
/// rate, bursts and events can give birth to within the longest life. Events are between the
/// emitters given; of a collision that a particle survives there may be any number. `h` is the
/// tick [s].
std::vector<double> most_alive(std::span<const NamedEmitter> emitters, double h);

}  // namespace tumble
