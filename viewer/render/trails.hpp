#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/particle_trails.hpp"
#include "viewer/render/render_scene.hpp"

#include <deque>
#include <vector>

namespace tumble {

/// The paths of moving bodies over the last seconds, drawn as lines that fade with age. Positions
/// are sampled at every n-th tick, with n fixed by the first frame, so that the drawing does not
/// depend on when pictures are made. Particles have paths of the length that their look gives.
class Trails {
 public:
  /// Sets how far back paths reach [s]; 0: no paths are kept. Drops what was recorded before.
  void start(double seconds);
  /// Takes the next frame. A frame that is not later than the last (after a seek or restart)
  /// removes the samples after it.
  void see(const Frame& frame);
  /// Adds the lines up to the fraction `s` of the way between two frames, which must be the latest
  /// that see() was given.
  void draw(const Frame& from, const Frame& to, double s, RenderScene& out) const;

 private:
  struct Place {
    BodyId id;  ///< null: the slot has no path here
    Vec3 x;     ///< [m]
  };
  struct Sample {
    uint64_t tick = 0;
    double time = 0;            ///< [s]
    std::vector<Place> places;  ///< by body slot
  };
  void keep(const Frame& frame);

  double seconds_ = 0;
  uint64_t interval_ = 0;       ///< ticks between samples; 0: no frame was seen yet
  std::deque<Sample> samples_;  ///< oldest first
  std::vector<BodyId> jumped_;  ///< bodies moved by hand since the newest sample
  uint64_t seen_tick_ = 0;      ///< tick of the latest frame
  bool came_back_ = false;      ///< that tick was reached by going back
  ParticleTrails particles_;
};

}  // namespace tumble
