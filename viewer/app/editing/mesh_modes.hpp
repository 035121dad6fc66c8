#pragma once
#include "engine/core/stop.hpp"
#include "viewer/ui/ui_state.hpp"

#include <future>
#include <memory>
#include <optional>

namespace tumble {

/// Makes and measures what meshes collide as, on a thread of its own, so that neither the picture
/// nor the simulation waits. One piece of work at a time: of what is asked for meanwhile nothing is
/// begun.
class MeshModes {
 public:
  MeshModes() = default;
  ~MeshModes() { stop_.request(); }
  MeshModes(const MeshModes&) = delete;
  MeshModes& operator=(const MeshModes&) = delete;

  void measure(const MeasureMesh& wish);
  void change(const ChangeMeshMode& wish);

  /// The shapes that were asked for, or why there are none.
  struct Change {
    ChangeMeshMode wish;
    Result<MeshParts> parts;
  };
  /// Takes what has been finished: a change, once; a measurement is kept.
  std::optional<Change> take();
  /// A change that is still being made is for a world that is gone.
  void forget() { forgotten_ = changing(); }
  std::shared_ptr<const MeasuredMesh> measured() const { return measured_; }
  bool changing() const { return change_.valid(); }
  bool measuring() const { return measurement_.valid(); }

 private:
  StopFlag stop_;  ///< before the futures, whose threads look at it until they are gone
  std::future<Change> change_;
  std::future<std::shared_ptr<const MeasuredMesh>> measurement_;
  std::shared_ptr<const MeasuredMesh> measured_;
  bool forgotten_ = false;
};

}  // namespace tumble
