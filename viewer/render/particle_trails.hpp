#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/render_scene.hpp"

#include <deque>
#include <vector>

namespace tumble {

/// The paths of the particles of systems whose look has a trail, drawn as lines that fade with age.
/// Places are kept at every n-th tick, n fixed by trail and tick, so that what is drawn does not
/// depend on when pictures are made.
class ParticleTrails {
 public:
  /// The next frame; see Trails::see().
  void see(const Frame& frame);
  /// Lines up to the moment `s` of the way between two frames, the latest that were seen.
  void draw(const Frame& from, const Frame& to, double s, RenderScene& out) const;

 private:
  struct Sample {
    uint64_t tick = 0;
    double time = 0;            ///< [s]
    std::vector<uint64_t> ids;  ///< ascending
    std::vector<Vec3> x;        ///< [m]
  };
  struct Path {
    ParticleSystemId id;
    std::deque<Sample> samples;  ///< oldest first
  };
  std::vector<Path> paths_;
};

}  // namespace tumble
