#pragma once
#include "engine/collision/shape.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "viewer/render/mesh.hpp"

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// One level of a hierarchy as it is drawn, in the frame of its mesh.
struct HierarchyView {
  struct Wire {
    Vec3 a, b;
    Vec4f colour;
  };
  struct Piece {
    MeshRef mesh;
    Vec3f colour;
  };
  std::vector<Wire> wires;  ///< edges of all volumes
  /// Triangles by the volume that contains them; empty if there are too many.
  std::vector<Piece> pieces;
  size_t volumes = 0;

  static constexpr size_t most_pieces = 256;
};

/// Makes the view of one level; `with_pieces` also divides the mesh by volume.
HierarchyView make_hierarchy_view(const Hierarchy& hierarchy, int level, bool with_pieces);

/// Cache of hierarchies of triangle meshes for drawing, built once for each mesh and kind. For each
/// of them the view of the level requested last is kept.
class HierarchyViews {
 public:
  /// Null for shapes that are not triangle meshes, and for unknown kinds.
  const Hierarchy* find_or_make(const std::shared_ptr<const Shape>& shape, std::string_view kind);
  const HierarchyView* view(const std::shared_ptr<const Shape>& shape, std::string_view kind,
                            int level, bool with_pieces);
  /// Drops entries whose shapes no longer exist.
  void prune();
  size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    std::weak_ptr<const Shape> shape;
    std::unique_ptr<Hierarchy> hierarchy;
    int level = -1;
    bool with_pieces = false;
    HierarchyView view;
  };
  Entry* entry(const std::shared_ptr<const Shape>& shape, std::string_view kind);

  std::map<std::pair<const Shape*, std::string>, Entry> entries_;
};

}  // namespace tumble
