#pragma once
#include "viewer/app/editing/parts_desk.hpp"
#include "viewer/app/session/refusal.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tumble {

/// A deed that takes something away, and with it what cannot be without: joints, springs, sensors
/// and emitters that name it leave the world and the scene's file in the same deed, others lose the
/// name, and a person is told. For jobs on the simulation thread.
class Removal {
 public:
  /// `deeds`: all that the file has to take up, the deed itself (`edits`) the last of them.
  Removal(const SceneFile& file, std::vector<DeedEdits> deeds, DeedEdits edits,
          const PartsDesk& desk, Refusal told);
  /// Notes what has been taken away in the world, and takes along what named it.
  void take(World& world, const SceneEdit& removal) const;
  /// After all has been taken: parts that stay without a name are described anew, and what was
  /// taken along is told.
  void finish(World& world) const;

 private:
  void describe_anew(World& world) const;

  /// Common to the copies, which a job is.
  struct Taking {
    std::string text, file;              ///< as the scene was opened; "": there is no file
    std::unique_ptr<FileRemovals> rest;  ///< what is left of it
    std::vector<TakenAlong> along;
  };
  std::shared_ptr<Taking> taking_ = std::make_shared<Taking>();
  std::vector<DeedEdits> deeds_;
  DeedEdits edits_;
  std::shared_ptr<const SceneDescription> parts_;
  std::shared_ptr<LiveParts> live_;
  Refusal told_;
};

}  // namespace tumble
