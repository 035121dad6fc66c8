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
  /// The field of a mesh with cells of this edge [m], from the cache or computed and stored. Errors
  /// are those of make_distance_field(). The field does not depend on the crew.
  Result<std::shared_ptr<const DistanceField>> field(
      const std::shared_ptr<const TriangleMesh>& mesh, double cell, Crew* crew = nullptr) const;

 private:
  ContentCache cache_;
};

}  // namespace tumble
