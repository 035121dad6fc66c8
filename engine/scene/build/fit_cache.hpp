#pragma once
#include "engine/collision/fitting/fit_primitive.hpp"
#include "engine/scene/build/content_cache.hpp"

namespace tumble {

/// Cache of fitted primitives (content_cache.hpp).
class FitCache {
 public:
  FitCache() : FitCache(ContentCache::usual_folder("fits")) {}
  explicit FitCache(std::filesystem::path folder) : cache_(std::move(folder), ".fit") {}

  const std::filesystem::path& folder() const { return cache_.folder(); }
  /// The primitives fitted to a mesh, best first, from the cache or computed and stored. Errors are
  /// those of fit_primitives().
  Result<std::vector<FittedPrimitive>> fits(const std::shared_ptr<const TriangleMesh>& mesh) const;
  /// The first of fits().
  Result<FittedPrimitive> fit(const std::shared_ptr<const TriangleMesh>& mesh) const;

 private:
  ContentCache cache_;
};

}  // namespace tumble
