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

/// Greatest number of particles or bodies of each emitter that may be alive at once, infinite if
/// unbounded: what rate, bursts and events can create within the longest life. Events are between
/// the given emitters; a collision that a particle survives may happen any number of times. `h` is
/// the tick [s].
std::vector<double> most_alive(std::span<const NamedEmitter> emitters, double h);

}  // namespace tumble
