#pragma once
#include "engine/core/log.hpp"
#include "engine/world/settings.hpp"

#include <memory>

namespace tumble {

class World;

/// What a world is made from.
struct WorldDef {
  WorldSettings settings;
  int threads = 0;  ///< 0: one per core; never part of the state
  LogSink log;      ///< receives warnings, within a tick: it must not ask for a frame
};

}  // namespace tumble

/// Whoever only holds a world needs to know no more of it than its name: what holds one does not
/// read world.hpp, and is not compiled again with each change of that.
template <>
struct std::default_delete<tumble::World> {
  void operator()(tumble::World* world) const noexcept;  ///< in world.cpp
};
