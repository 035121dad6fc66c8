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

/// How fast pictures follow each other, and how long drawing one takes; both smoothed [s].
class DrawingPace {
 public:
  /// `period`: of the display; 0: not known [s].
  void begin_picture(double dt, double period = 0);
  void end_picture();
  uint64_t pictures() const { return pictures_; }
  double picture_seconds() const { return picture_seconds_; }
  double drawing_seconds() const { return drawing_seconds_; }
  /// Pictures have been slow for a while; stays so.
  bool is_slow() const;
  /// With how many of its pixels the world can be drawn in time: the picture under way is. What
  /// pictures drawn otherwise take says nothing about it. A world that has stood still for a
  /// moment, seen from the same place, is drawn with all of them: nobody waits for the next
  /// picture.
  float use_resolution(bool still);

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begun_;
  uint64_t pictures_ = 0;
  double picture_seconds_ = 0, drawing_seconds_ = 0;
  int slow_pictures_ = 0;  ///< in a row
  ResolutionControl control_;
  double dt_ = 0;         ///< of the picture under way [s]
  double rest_ = 0;       ///< for how long nothing has moved [s]
  bool reduced_ = false;  ///< the last picture was drawn with its resolution
};

/// What pictures of the window are drawn with, and the picture itself: renderer, meshes and trails
/// of the scene, and how long it all takes.
class Canvas {
 public:
  static Result<Canvas> create(Device& device, const std::filesystem::path& shaders);

  /// Another scene: its light and ground, and how long its trails are [s].
  void open(const std::function<void(RenderScene&)>& look, double trail_seconds);
  /// A frame that follows on those before, or one that nobody has seen the way to.
  void see(const Frame& frame, bool way_is_known);
  /// Fills the picture with a moment of the world.
  void compose(const SessionView& shown, const ExtractOptions& options, const Camera& camera);
  /// Draws it with these panels over it.
  Status draw(UiDrawList& panels, int width, int height);
  /// The same with another picture beside it.
  Status draw_beside(const RenderScene& right, const SideBySide& places, UiDrawList& panels,
                     int width, int height);
  /// The best that is fluent; `captured`: pictures that are kept are no drafts.
  Quality quality(PictureQuality wanted, bool captured) const;
  /// To be asked once for each picture.
  float resolution(PictureQuality wanted, bool captured);
  /// Whether the picture that was composed shows what the one before it showed, from there.
  bool still() const { return still_; }
  /// Lets go of what no picture has needed for long.
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
  std::string renderer_name_;  ///< as the driver says
  bool software_ = false;      ///< the device draws on the processor
  ShapeMeshes meshes_;
  Trails trails_;
  double trail_seconds_ = 0;
  RenderScene picture_;
  SessionView shown_;  ///< the moment of the world in it
  bool still_ = false;
  FrameReport report_;
  DrawingPace pace_;
};

}  // namespace tumble
