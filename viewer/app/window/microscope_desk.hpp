#pragma once
#include "engine/world/microscope/microscope.hpp"
#include "viewer/ui/ui_state.hpp"

#include <optional>

namespace tumble {

/// What lies under the microscope: what the scene puts there, else a selected body and its
/// neighbour.
class MicroscopeDesk {
 public:
  void open(std::optional<MicroscopeSetup> of_scene);
  bool empty() const { return !setup_; }
  /// With what a person chose instead of the scene's algorithm.
  std::optional<MicroscopeSetup> setup(const MicroscopeChoice& choice) const;
  /// Puts a body and its neighbour there, or without a body what needs none; false when no
  /// microscope takes them.
  bool put(const Frame& frame, BodyId body);
  /// Takes away what a person put there; false when it is the scene's, or nothing.
  bool take_away();

 private:
  std::optional<MicroscopeSetup> setup_;
  bool put_by_person_ = false;
};

}  // namespace tumble
