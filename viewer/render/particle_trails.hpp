#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/render_scene.hpp"

#include <deque>
#include <vector>

namespace tumble {

/// The paths of particles whose look has a trail, drawn as lines that fade with age. Positions are
/// sampled at every n-th tick, with n depending only on the length of the trail and the tick, so
/// that the drawing does not depend on when pictures are made.
class ParticleTrails {
 public:
  /// Takes the next frame; see Trails::see().
  void see(const Frame& frame);
  /// Adds the lines up to the fraction `s` of the way between two frames, which must be the latest
  /// that see() was given.
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
