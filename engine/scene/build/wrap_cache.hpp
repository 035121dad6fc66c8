#pragma once
#include "engine/geometry/wrap/wrap_mesh.hpp"
#include "engine/scene/build/content_cache.hpp"

#include <memory>
#include <string>

namespace tumble {

struct WrapDescription;

/// Wraps that were made before (content_cache.hpp).
class WrapCache {
 public:
  WrapCache() : WrapCache(ContentCache::usual_folder("wraps")) {}
  explicit WrapCache(std::filesystem::path folder) : cache_(std::move(folder), ".wrap") {}

  const std::filesystem::path& folder() const { return cache_.folder(); }
  /// The wrap of a mesh: from the cache, or made and put there. Errors are those of wrap_mesh(). It
  /// is the same with any crew or none.
  Result<WrappedMesh> wrap(const std::shared_ptr<const TriangleMesh>& mesh,
                           const WrapOptions& options) const;

 private:
  ContentCache cache_;
};

/// What a description asks for.
WrapOptions wrap_options(const WrapDescription& d);
/// How far a wrap is from its mesh, both ways, for people.
std::string wrap_note(const WrappedMesh& wrap);

}  // namespace tumble
