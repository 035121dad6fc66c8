#pragma once
#include "engine/core/crew.hpp"

#include <memory>
#include <mutex>

namespace tumble {

struct Frame;
class QueryScene;

/// The query scene of a world's last frame, made when it is first asked for.
class QueryCache {
 public:
  /// May be called from several threads; those that call while it is made wait for it.
  std::shared_ptr<const QueryScene> of(const std::shared_ptr<const Frame>& frame, Crew* crew) const;

 private:
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const QueryScene> scene_;
};

}  // namespace tumble
