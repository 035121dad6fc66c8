#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/render_scene.hpp"

#include <map>
#include <vector>

namespace tumble {

/// The particles that meshes of springs draw as cloth, net or rope, and that are no balls then.
class WovenParticles {
 public:
  explicit WovenParticles(const Frame& frame);
  bool holds(ParticleSystemId system, uint64_t particle) const;

 private:
  std::map<uint32_t, std::vector<uint64_t>> by_system_;  ///< ascending
};

/// Cloths as smooth surfaces that are seen from both sides, ropes and nets as tubes, at the moment
/// `s` of the way from one frame to the next.
void add_weaves(const Frame& from, const Frame& to, double s, RenderScene& out);

}  // namespace tumble
