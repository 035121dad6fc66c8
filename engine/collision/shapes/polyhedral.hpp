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

 protected:
  virtual MeshSurface make_surface() const = 0;

 private:
  mutable std::once_flag once_;
  mutable std::optional<MeshSurface> surface_;
};

}  // namespace tumble
