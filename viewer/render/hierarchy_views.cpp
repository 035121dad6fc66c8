#include "viewer/render/hierarchy_views.hpp"

#include "engine/geometry/hierarchy/level.hpp"

#include <algorithm>

namespace tumble {
namespace {

class WireSink final : public DebugDraw {
 public:
  explicit WireSink(std::vector<HierarchyView::Wire>& out) : out_(out) {}
  void line(const Vec3& a, const Vec3& b, const Vec4f& colour) override {
    out_.push_back({a, b, colour});
  }
  void point(const Vec3&, const Vec4f&, float) override {}
  void text(const Vec3&, const Vec4f&, std::string_view) override {}

 private:
  std::vector<HierarchyView::Wire>& out_;
};

MeshRef piece_of(const TriangleMesh& mesh, std::span<const uint32_t> triangles) {
  std::vector<Vec3> positions;
  std::vector<uint32_t> indices;
  std::map<uint32_t, uint32_t> number;
  for (const uint32_t t : triangles)
    for (const uint32_t v : mesh.triangles[t]) {
      const auto [at, fresh] = number.emplace(v, uint32_t(positions.size()));
      if (fresh) positions.push_back(mesh.vertices[v]);
      indices.push_back(at->second);
    }
  return make_mesh_from_triangles(positions, indices);
}

}  // namespace

HierarchyView make_hierarchy_view(const Hierarchy& hierarchy, int level, bool with_pieces) {
  HierarchyView view;
  WireSink sink(view.wires);
  const std::vector<NodeBound> bounds = level_bounds(hierarchy, level);
  view.volumes = bounds.size();
  for (const NodeBound& bound : bounds) {
    const Vec4f colour = node_colour(hierarchy, bound);
    draw_bound(bound, {}, colour, sink);
    if (with_pieces && bounds.size() <= HierarchyView::most_pieces)
      if (MeshRef mesh = piece_of(hierarchy.mesh(), bound.triangles))
        view.pieces.push_back({std::move(mesh), colour.head<3>()});
  }
  return view;
}

HierarchyViews::Entry* HierarchyViews::entry(const std::shared_ptr<const Shape>& shape,
                                             std::string_view kind) {
  if (!shape->is_mesh()) return nullptr;
  Entry& e = entries_[{shape.get(), std::string(kind)}];
  // A new shape may have the address of a deleted one.
  if (e.hierarchy && e.shape.lock() == shape) return &e;
  for (const HierarchyKind& k : all_hierarchies()) {
    if (k.name != kind) continue;
    e = Entry{shape, k.build(shape->def().mesh), -1, false, {}};
    return &e;
  }
  entries_.erase({shape.get(), std::string(kind)});
  return nullptr;
}

const Hierarchy* HierarchyViews::find_or_make(const std::shared_ptr<const Shape>& shape,
                                              std::string_view kind) {
  const Entry* e = entry(shape, kind);
  return e ? e->hierarchy.get() : nullptr;
}

const HierarchyView* HierarchyViews::view(const std::shared_ptr<const Shape>& shape,
                                          std::string_view kind, int level, bool with_pieces) {
  Entry* e = entry(shape, kind);
  if (!e) return nullptr;
  level = std::clamp(level, 0, e->hierarchy->depth());
  if (e->level != level || (with_pieces && !e->with_pieces)) {
    e->view = make_hierarchy_view(*e->hierarchy, level, with_pieces);
    e->level = level;
    e->with_pieces = with_pieces;
  }
  return &e->view;
}

void HierarchyViews::prune() {
  std::erase_if(entries_, [](const auto& e) { return e.second.shape.expired(); });
}

}  // namespace tumble
