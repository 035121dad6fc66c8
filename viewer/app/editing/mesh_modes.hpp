#pragma once
#include "engine/core/stop.hpp"
#include "viewer/ui/ui_state.hpp"

#include <future>
#include <memory>
#include <optional>

namespace tumble {

/// Computes and measures collision representations of meshes on a thread of its own, so that
/// neither drawing nor simulation waits. One computation at a time; requests made meanwhile are
/// ignored.
class MeshModes {
 public:
  MeshModes() = default;
  ~MeshModes() { stop_.request(); }
  MeshModes(const MeshModes&) = delete;
  MeshModes& operator=(const MeshModes&) = delete;

  void measure(const MeasureMesh& wanted);
  void change(const ChangeMeshMode& wanted);

  /// The requested shapes, or why there are none.
  struct Change {
    ChangeMeshMode request;
    Result<MeshParts> parts;
  };
  /// Takes a finished result: a change is returned once, a measurement is kept.
  std::optional<Change> take();
  /// A change under way was for a world that is no longer shown.
  void forget() { forgotten_ = changing(); }
  std::shared_ptr<const MeasuredMesh> measured() const { return measured_; }
  bool changing() const { return change_.valid(); }
  bool measuring() const { return measurement_.valid(); }

 private:
  StopFlag stop_;  ///< declared before the futures, whose threads use it until they end
  std::future<Change> change_;
  std::future<std::shared_ptr<const MeasuredMesh>> measurement_;
  std::shared_ptr<const MeasuredMesh> measured_;
  bool forgotten_ = false;
};

}  // namespace tumble
