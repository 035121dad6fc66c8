#pragma once
#include "engine/core/log.hpp"
#include "engine/world/settings.hpp"

#include <memory>

namespace tumble {

class World;

/// The definition of a world.
struct WorldDef {
  WorldSettings settings;
  int threads = 0;  ///< 0: one per core; not part of the state
  LogSink log;      ///< receives warnings during a tick; it must not ask for a frame
};

}  // namespace tumble

/// Lets a file hold a World by unique_ptr without including world.hpp, so that it is not compiled
/// again with each change of that.
template <>
struct std::default_delete<tumble::World> {
  void operator()(tumble::World* world) const noexcept;  ///< in world.cpp
};
