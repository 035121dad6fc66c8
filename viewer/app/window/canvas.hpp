#pragma once
#include "viewer/app/session/session.hpp"
#include "viewer/render/extract.hpp"
#include "viewer/render/renderer.hpp"
#include "viewer/render/resolution_control.hpp"
#include "viewer/render/trails.hpp"
#include "viewer/ui/ui_state.hpp"

#include <chrono>
#include <filesystem>
#include <functional>

namespace tumble {

/// The time between pictures and the time to draw one; both smoothed [s].
class DrawingPace {
 public:
  /// `dt`: time since the last picture [s]; `period`: that of the display, 0: not known [s].
  void begin_picture(double dt, double period = 0);
  void end_picture();
  uint64_t pictures() const { return pictures_; }
  double picture_seconds() const { return picture_seconds_; }
  double drawing_seconds() const { return drawing_seconds_; }
  /// Whether pictures have been slow for a while; once true it stays true.
  bool is_slow() const;
  /// Resolution for the picture about to be drawn, so that it is drawn in time (ResolutionControl).
  /// Pictures drawn without this resolution do not count as measurements. A world that has stood
  /// still for a moment, seen by a camera at rest, is drawn at full resolution, since nobody waits
  /// for the next picture.
  float use_resolution(bool still);

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begun_;
  uint64_t pictures_ = 0;
  double picture_seconds_ = 0, drawing_seconds_ = 0;
  int slow_pictures_ = 0;  ///< slow pictures in a row
  ResolutionControl control_;
  double dt_ = 0;         ///< of the picture being drawn [s]
  double rest_ = 0;       ///< for how long nothing has moved [s]
  bool reduced_ = false;  ///< the last picture was drawn with this resolution
};

/// Everything needed to draw the window's pictures: renderer, meshes and trails of the scene, the
/// picture itself, and the time that drawing takes.
class Canvas {
 public:
  static Result<Canvas> create(Device& device, const std::filesystem::path& shaders);

  /// For another scene: sets its light and ground, and the length of its trails [s].
  void open(const std::function<void(RenderScene&)>& look, double trail_seconds);
  /// Sets another length of the trails [s], which begin anew; 0: there are none.
  void set_trail(double seconds);
  /// Takes the next frame; `way_is_known`: it follows the frames before without a gap.
  void see(const Frame& frame, bool way_is_known);
  /// Fills the picture with a moment of the world.
  void compose(const SessionView& shown, const ExtractOptions& options, const Camera& camera);
  /// Draws it with panels over it.
  Status draw(UiDrawList& panels, int width, int height);
  /// Draws it with another picture beside it, and panels over both.
  Status draw_beside(const RenderScene& right, const SideBySide& places, UiDrawList& panels,
                     int width, int height);
  /// The quality to draw with: for automatic, the best that is fluent. Pictures to be saved
  /// (`captured`) are never drafts.
  Quality quality(PictureQuality wanted, bool captured) const;
  /// The resolution to draw with; to be called once for each picture.
  float resolution(PictureQuality wanted, bool captured);
  /// Whether the composed picture shows the same as the one before it, from the same camera.
  bool still() const { return still_; }
  /// Frees what no picture has used for a while.
  void prune();

  RenderScene& picture() { return picture_; }
  const RenderScene& picture() const { return picture_; }
  ShapeMeshes& meshes() { return meshes_; }
  const ShapeMeshes& meshes() const { return meshes_; }
  Renderer& renderer() { return *renderer_; }
  const std::string& renderer_name() const { return renderer_name_; }
  DrawingPace& pace() { return pace_; }
  const DrawingPace& pace() const { return pace_; }
  const FrameReport& report() const { return report_; }

 private:
  Status take(Result<FrameReport> report, UiDrawList& panels);

  std::unique_ptr<Renderer> renderer_;
  std::string renderer_name_;  ///< as the driver reports it
  bool software_ = false;      ///< the device is a software renderer
  ShapeMeshes meshes_;
  Trails trails_;
  double trail_seconds_ = 0;
  RenderScene picture_;
  SessionView shown_;  ///< the moment of the world in the picture
  bool still_ = false;
  FrameReport report_;
  DrawingPace pace_;
};

}  // namespace tumble
