#pragma once
#include "engine/world/microscope/microscope.hpp"
#include "viewer/ui/ui_state.hpp"

#include <optional>

namespace tumble {

/// What the microscope shows: what the scene asks for, or else a selected body and its neighbour.
class MicroscopeController {
 public:
  void open(std::optional<MicroscopeSetup> of_scene);
  bool empty() const { return !setup_; }
  /// The setup, in which a choice of the user replaces the scene's algorithm.
  std::optional<MicroscopeSetup> setup(const MicroscopeChoice& choice) const;
  /// Puts a body and its neighbour under the microscope, or with a null body an algorithm that
  /// needs none; false if no microscope accepts them.
  bool put(const Frame& frame, BodyId body);
  /// Removes what the user put under the microscope; false if it was the scene or nothing is there.
  bool take_away();

 private:
  std::optional<MicroscopeSetup> setup_;
  bool put_by_person_ = false;
};

}  // namespace tumble
