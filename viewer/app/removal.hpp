#pragma once
#include "viewer/app/parts_desk.hpp"
#include "viewer/app/refusal.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tumble {

/// A deed that takes something away, and with it what cannot be without: joints, springs, sensors
/// and emitters that name it leave the world and the scene's file in the same deed, and a person is
/// told which. For jobs on the simulation thread.
class Removal {
 public:
  /// `deeds`: all that the file has to take up, the deed itself (`edits`) the last of them.
  Removal(std::string text, std::vector<DeedEdits> deeds, DeedEdits edits, const PartsDesk& desk,
          Refusal told);
  /// Notes what has been taken away in the world, and takes along what named it.
  void take(World& world, const SceneEdit& removal) const;
  /// Tells what was taken along.
  void say() const;

 private:
  std::string text_;  ///< of the scene as it was opened; "": there is no file
  std::vector<DeedEdits> deeds_;
  DeedEdits edits_;
  std::shared_ptr<const SceneDescription> parts_;
  std::shared_ptr<LiveParts> live_;
  Refusal told_;
  std::shared_ptr<std::vector<std::string>> along_ = std::make_shared<std::vector<std::string>>();
};

}  // namespace tumble
