#pragma once
#include "engine/world/microscope/microscope.hpp"
#include "viewer/render/render_scene.hpp"

#include <optional>

namespace tumble {

class ShapeMeshes;

/// Keeps the recording of what lies under the microscope, made anew when the bodies move, and draws
/// one of its steps.
class MicroscopeView {
 public:
  /// Null when the frame refuses the setup; why is refusal(). Of algorithms that ask the world
  /// there is what it `said`, null for nothing yet, of this very tick.
  const MicroscopeRecording* look(const Frame& frame, const std::vector<Pose>& poses,
                                  const MicroscopeSetup& setup,
                                  const std::shared_ptr<const MicroscopeAnswer>& said = nullptr);
  const MicroscopeRecording* recording() const { return recording_.get(); }
  /// Whether the recording wants this body seen through.
  bool sees_through(BodyId body) const;
  /// Colours of a system in the step that draw() is going to show; null for its own.
  const ParticleColours* colours(ParticleSystemId system, int step) const;
  const std::string& refusal() const { return refusal_; }
  /// The step that draw() showed last.
  int shown() const { return shown_; }
  void clear();

  /// A step of the recording that look() gave, clamped to those there are.
  void draw(int step, bool with_plate, ShapeMeshes& meshes, RenderScene& out);

 private:
  void draw_bodies(const Sketch& sketch, ShapeMeshes& meshes, RenderScene& out) const;
  void draw_surfaces(const Sketch& sketch, RenderScene& out);

  const MicroscopeRecording* take(const Frame& frame,
                                  const std::shared_ptr<const MicroscopeAnswer>& said);

  std::string algorithm_, refusal_;
  std::shared_ptr<const MicroscopeAnswer> said_;  ///< that `recording_` is of
  MicroscopeSlide slide_;
  std::shared_ptr<MicroscopeMemory> memory_;  ///< of recorders, made when it is first needed
  std::shared_ptr<const MicroscopeRecording> recording_;  ///< perhaps a part of `said_`
  int shown_ = 0;
  int meshes_of_ = -1;  ///< the step that `surfaces_` are of
  std::vector<MeshRef> surfaces_;
};

}  // namespace tumble
