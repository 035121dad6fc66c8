#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/camera.hpp"

#include <memory>
#include <optional>
#include <span>

namespace tumble {

class QueryScene;

/// What the pointer is on.
struct Pick {
  BodyId body;
  uint32_t slot = 0;
  uint32_t shape = 0;
  double distance = 0;  ///< along the ray [m]
  Vec3 x_world = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();     ///< outward, world axes
  Vec3 point_body = Vec3::Zero();  ///< in the definition's body frame, as an Anchor takes it
  BodyType type = BodyType::fixed;
};

/// The nearest visible body along a ray, in the picture between two frames of one world (s in
/// [0, 1]); bodies that the later frame has lost, and those ignored, are not hit. Reads frames
/// only, so that it may run on any thread.
std::optional<Pick> pick(const Frame& from, const Frame& to, double s, const Ray& ray,
                         double max_distance = 1e4, std::span<const BodyId> ignored = {});

/// Picks in picture after picture, with the same answers as pick(). While bodies move every picture
/// differs, and looking at all of them once is the fastest; where the picture stands still (paused,
/// asleep) it asks a tree from the second time on.
class Picker {
 public:
  std::optional<Pick> operator()(const std::shared_ptr<const Frame>& from,
                                 const std::shared_ptr<const Frame>& to, double s, const Ray& ray,
                                 double max_distance = 1e4);

 private:
  std::shared_ptr<const QueryScene> scene_;
  std::shared_ptr<const Frame> seen_;  ///< of the last picture
};

/// The slot of a body in a frame, if it is alive there.
std::optional<uint32_t> find_slot(const Frame& frame, BodyId id);

/// World bounds of a body, infinite shapes (half-spaces) left out; empty when nothing is left.
Aabb body_bounds(const Frame& frame, uint32_t slot);

}  // namespace tumble
