#pragma once
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/scene/build/content_cache.hpp"

namespace tumble {

/// Cache of distance fields (content_cache.hpp).
class FieldCache {
 public:
  FieldCache() : FieldCache(ContentCache::usual_folder("fields")) {}
  explicit FieldCache(std::filesystem::path folder) : cache_(std::move(folder), ".field") {}

  const std::filesystem::path& folder() const { return cache_.folder(); }
  /// The field of a mesh with cells of this side: from the cache, or made and put there. Errors are
  /// those of make_distance_field(). The field is the same with any crew or none.
  Result<std::shared_ptr<const DistanceField>> field(
      const std::shared_ptr<const TriangleMesh>& mesh, double cell, Crew* crew = nullptr) const;

 private:
  ContentCache cache_;
};

}  // namespace tumble
