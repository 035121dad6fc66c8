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

/// A level of a hierarchy as it is drawn, in the frame of its mesh.
struct HierarchyView {
  struct Wire {
    Vec3 a, b;
    Vec4f colour;
  };
  struct Piece {
    MeshRef mesh;
    Vec3f colour;
  };
  std::vector<Wire> wires;    ///< of all volumes
  std::vector<Piece> pieces;  ///< the triangles of each volume; none when there are too many
  size_t volumes = 0;

  static constexpr size_t most_pieces = 256;
};

/// The view of one level; `with_pieces` cuts the mesh as well.
HierarchyView make_hierarchy_view(const Hierarchy& hierarchy, int level, bool with_pieces);

/// Hierarchies of triangle meshes as the viewer draws them, built once for each mesh and kind; the
/// view of the level asked for last is kept with each.
class HierarchyViews {
 public:
  /// Null for shapes that are no triangle mesh and kinds that do not exist.
  const Hierarchy* find_or_make(const std::shared_ptr<const Shape>& shape, std::string_view kind);
  const HierarchyView* view(const std::shared_ptr<const Shape>& shape, std::string_view kind,
                            int level, bool with_pieces);
  /// Forgets what belongs to shapes that are gone.
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
