#pragma once
#include <memory>
#include <mutex>

#include <tbb/task_arena.h>

namespace tumble {

struct Frame;
class QueryScene;

/// The query scene of a world's last frame, made when it is asked for.
class QueryCache {
 public:
  /// Safe from several threads; those that come while it is made wait for it.
  std::shared_ptr<const QueryScene> of(const std::shared_ptr<const Frame>& frame,
                                       tbb::task_arena* arena) const;

 private:
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const QueryScene> scene_;
};

}  // namespace tumble
