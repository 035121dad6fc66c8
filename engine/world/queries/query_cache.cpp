#include "engine/world/queries/query_cache.hpp"

#include "engine/world/queries/query_scene.hpp"

namespace tumble {

std::shared_ptr<const QueryScene> QueryCache::of(const std::shared_ptr<const Frame>& frame,
                                                 tbb::task_arena* arena) const {
  const std::lock_guard lock(mutex_);
  if (!scene_ || !scene_->serves(*frame)) scene_ = std::make_shared<QueryScene>(frame, arena);
  return scene_;
}

}  // namespace tumble
