#include "engine/world/queries/query_scene.hpp"

namespace tumble {

QueryScene::QueryScene(std::shared_ptr<const Frame> frame, Crew* crew) : frame_(std::move(frame)) {
  std::vector<Aabb> bounds;
  placed_.reserve(frame_->body_slots());
  bounds.reserve(frame_->body_slots());
  for (size_t slot = 0; slot < frame_->body_slots(); ++slot) {
    const BodyFrame& body = frame_->body(slot);
    if (body.id.is_null()) continue;
    const BodyInfo& info = frame_->info(slot);
    for (uint32_t k = 0; k < info.shapes.size(); ++k) {
      const BodyShape& part = info.shapes[k];
      placed_.push_back({part.shape.get(), body.pose * part.pose, {body.id, k, {}, 0}, info.type});
      bounds.push_back(part.shape->bounds(placed_.back().pose));
    }
  }
  tree_ = BoundsTree(bounds, crew);
}

bool QueryScene::serves(const Frame& frame) const {
  // Parts of frames that did not change are shared; those of particles never are.
  return &frame == frame_.get() ||
         (frame.chunks == frame_->chunks && frame.infos == frame_->infos &&
          frame.particles.empty() && frame_->particles.empty());
}

const QueryScene::Balls& QueryScene::balls() const {
  std::call_once(balls_once_, [this] {
    std::vector<Aabb> bounds;
    for (const auto& system : frame_->particles) {
      for (uint32_t i = 0; i < system->x.size(); ++i) {
        balls_.targets.push_back({{}, 0, system->id, i});
        const Vec3& x = system->x[i];
        bounds.push_back(Aabb{x, x}.inflated(system->radius[i]));
      }
    }
    balls_.tree = BoundsTree(bounds);
  });
  return balls_;
}

QueryScene::Ball QueryScene::ball(const QueryTarget& target) const {
  for (const auto& system : frame_->particles)
    if (system->id == target.particles)
      return {system->x[target.particle], system->radius[target.particle]};
  return {Vec3::Zero(), 0};
}

}  // namespace tumble
