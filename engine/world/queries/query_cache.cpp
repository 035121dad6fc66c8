#include "engine/world/queries/query_cache.hpp"

#include "engine/world/queries/query_scene.hpp"

namespace tumble {

std::shared_ptr<const QueryScene> QueryCache::of(const std::shared_ptr<const Frame>& frame,
                                                 Crew* crew) const {
  const std::lock_guard lock(mutex_);
  if (!scene_ || !scene_->serves(*frame)) scene_ = std::make_shared<QueryScene>(frame, crew);
  return scene_;
}

}  // namespace tumble
