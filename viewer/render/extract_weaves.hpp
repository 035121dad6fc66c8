#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/render_scene.hpp"

#include <map>
#include <vector>

namespace tumble {

/// The particles that are nodes of meshes of springs: these are drawn as cloth, net or rope, and
/// their particles not as balls.
class WovenParticles {
 public:
  explicit WovenParticles(const Frame& frame);
  bool holds(ParticleSystemId system, uint64_t particle) const;

 private:
  std::map<uint32_t, std::vector<uint64_t>> by_system_;  ///< ascending
};

/// Adds cloths as smooth two-sided surfaces, and ropes and nets as tubes, at the fraction `s` of
/// the way between two frames.
void add_weaves(const Frame& from, const Frame& to, double s, RenderScene& out);

}  // namespace tumble
