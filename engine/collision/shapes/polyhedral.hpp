#pragma once
#include "engine/collision/mesh_pairs/mesh_surface.hpp"

#include <mutex>
#include <optional>

namespace tumble {

/// A shape that is bounded by triangles: meshes, and boxes and hulls in contact with a mesh. The
/// surface is built on first use and then shared.
class Polyhedral {
 public:
  virtual ~Polyhedral() = default;
  const MeshSurface& surface() const {
    std::call_once(once_, [this] { surface_.emplace(make_surface()); });
    return *surface_;
  }
  /// The same seen from behind, with the same numbers of vertices, edges and triangles: what is
  /// behind an open mesh meets this one. Built on first use.
  const MeshSurface& reversed() const {
    std::call_once(reversed_once_, [this] { reversed_.emplace(reversed_surface(surface())); });
    return *reversed_;
  }

 protected:
  virtual MeshSurface make_surface() const = 0;

 private:
  mutable std::once_flag once_, reversed_once_;
  mutable std::optional<MeshSurface> surface_, reversed_;
};

}  // namespace tumble
