#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/camera.hpp"

#include <memory>
#include <optional>
#include <span>

namespace tumble {

class QueryScene;

/// The result of picking.
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

/// The nearest visible body along a ray, in the picture between two frames of one world (s in [0,
/// 1]). Bodies missing in the later frame, and those in the ignore list, are not hit. Only reads
/// frames, so it may be called on any thread.
std::optional<Pick> pick(const Frame& from, const Frame& to, double s, const Ray& ray,
                         double max_distance = 1e4, std::span<const BodyId> ignored = {});

/// Picks repeatedly, with the same results as pick(). While bodies move, testing all of them once
/// per picture is fastest; for still pictures (paused, asleep) it uses a tree from the second query
/// on.
class Picker {
 public:
  std::optional<Pick> operator()(const std::shared_ptr<const Frame>& from,
                                 const std::shared_ptr<const Frame>& to, double s, const Ray& ray,
                                 double max_distance = 1e4);

 private:
  std::shared_ptr<const QueryScene> scene_;
  std::shared_ptr<const Frame> seen_;  ///< frame of the last query
};

/// The slot of a body in a frame, if it is alive there.
std::optional<uint32_t> find_slot(const Frame& frame, BodyId id);

/// World bounds of a body without unbounded shapes (half spaces); empty if nothing remains.
Aabb body_bounds(const Frame& frame, uint32_t slot);

}  // namespace tumble
