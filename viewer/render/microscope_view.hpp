#pragma once
#include "engine/world/microscope/microscope.hpp"
#include "viewer/render/render_scene.hpp"

#include <optional>

namespace tumble {

class ShapeMeshes;

/// Holds the recording of the algorithm under the microscope, renews it when the bodies move, and
/// draws one of its steps.
class MicroscopeView {
 public:
  /// Null if the frame rejects the setup; refusal() says why. Algorithms that need the world
  /// (ask_world) use the answer `said`, which must be of this very tick; null if there is none yet.
  const MicroscopeRecording* look(const Frame& frame, const std::vector<Pose>& poses,
                                  const MicroscopeSetup& setup,
                                  const std::shared_ptr<const MicroscopeAnswer>& said = nullptr);
  const MicroscopeRecording* recording() const { return recording_.get(); }
  /// Whether the recording wants this body drawn transparent.
  bool sees_through(BodyId body) const;
  /// Colours of a particle system in the step that draw() is going to show; null: the system keeps
  /// its own.
  const ParticleColours* colours(ParticleSystemId system, int step) const;
  const std::string& refusal() const { return refusal_; }
  /// The step drawn last.
  int shown() const { return shown_; }
  void clear();

  /// Draws a step of the recording that look() returned; `step` is clamped to the existing ones.
  void draw(int step, bool with_plate, ShapeMeshes& meshes, RenderScene& out);

 private:
  void draw_bodies(const Sketch& sketch, ShapeMeshes& meshes, RenderScene& out) const;
  void draw_surfaces(const Sketch& sketch, RenderScene& out);

  const MicroscopeRecording* take(const Frame& frame,
                                  const std::shared_ptr<const MicroscopeAnswer>& said);

  std::string algorithm_, refusal_;
  std::shared_ptr<const MicroscopeAnswer> said_;  ///< the answer from which `recording_` was made
  MicroscopeSlide slide_;
  std::shared_ptr<MicroscopeMemory> memory_;  ///< memory of the recorders, made on first use
  std::shared_ptr<const MicroscopeRecording> recording_;  ///< may be a part of `said_`
  int shown_ = 0;
  int meshes_of_ = -1;  ///< the step that `surfaces_` belong to
  std::vector<MeshRef> surfaces_;
};

}  // namespace tumble
