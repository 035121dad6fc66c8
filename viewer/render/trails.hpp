#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/particle_trails.hpp"
#include "viewer/render/render_scene.hpp"

#include <deque>
#include <vector>

namespace tumble {

/// The paths of moving bodies over the last seconds, drawn as lines that fade with age. Fed with
/// frames as they come; places are kept at every n-th tick, n fixed by the first frame, so that
/// what is drawn does not depend on when pictures are made. Particles have paths of the length that
/// their look says.
class Trails {
 public:
  /// How far back paths reach [s]; 0: none are kept. Forgets what was seen before.
  void start(double seconds);
  /// The next frame. One that is not later than those seen (going back, a restart) takes away what
  /// came after it.
  void see(const Frame& frame);
  /// Lines up to the moment `s` of the way between two frames, the latest that were seen.
  void draw(const Frame& from, const Frame& to, double s, RenderScene& out) const;

 private:
  struct Place {
    BodyId id;  ///< null: no path here
    Vec3 x;     ///< [m]
  };
  struct Sample {
    uint64_t tick = 0;
    double time = 0;            ///< [s]
    std::vector<Place> places;  ///< by body slot
  };
  void keep(const Frame& frame);

  double seconds_ = 0;
  uint64_t interval_ = 0;       ///< ticks from sample to sample; 0: no frame was seen
  std::deque<Sample> samples_;  ///< oldest first
  std::vector<BodyId> jumped_;  ///< since the newest sample
  uint64_t seen_tick_ = 0;      ///< of the latest frame
  bool came_back_ = false;      ///< to that tick
  ParticleTrails particles_;
};

}  // namespace tumble
