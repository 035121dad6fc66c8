#pragma once
#include "viewer/app/editing/parts_controller.hpp"
#include "viewer/app/session/refusal.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tumble {

/// A removal together with everything that depends on the removed thing: joints, springs, sensors
/// and emitters that refer to it are removed from the world and the scene's file in the same undo
/// step, other references are dropped, and the user is informed. For jobs on the simulation thread.
class Removal {
 public:
  /// `undo_steps`: all unsaved edits, those of the removal itself (`edits`) last.
  Removal(const SceneFile& file, std::vector<UndoStepEdits> undo_steps, UndoStepEdits edits,
          const PartsController& controller, Refusal told);
  /// Records what was removed from the world, and removes what depended on it.
  void take(World& world, const SceneEdit& removal) const;
  /// To be called after all removals: remaining parts that lost a reference are described anew, and
  /// dependent removals are reported.
  void finish(World& world) const;

 private:
  void describe_anew(World& world) const;

  /// Shared by the copies of this job.
  struct Taking {
    std::string text, file;              ///< of the scene as it was opened; "": there is no file
    std::unique_ptr<FileRemovals> rest;  ///< what remains of it
    std::vector<TakenAlong> along;
  };
  std::shared_ptr<Taking> taking_ = std::make_shared<Taking>();
  std::vector<UndoStepEdits> undo_steps_;
  UndoStepEdits edits_;
  std::shared_ptr<const SceneDescription> parts_;
  std::shared_ptr<LiveParts> live_;
  Refusal told_;
};

}  // namespace tumble
