#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/extract.hpp"

#include <algorithm>

namespace tumble {
namespace {

bool has_triangle_mesh(const BodyInfo& info) {
  return std::any_of(info.shapes.begin(), info.shapes.end(),
                     [](const BodyShape& part) { return part.shape->is_mesh(); });
}

/// The overlay is of this body alone; no_index: of all.
size_t overlaid_slot(const Frame& frame, BodyId selected) {
  const size_t slot = selected.index;
  const bool alive =
      !selected.is_null() && slot < frame.body_slots() && frame.body(slot).id == selected;
  return alive && has_triangle_mesh(frame.info(slot)) ? slot : no_index;
}

}  // namespace

ShownHierarchy shown_hierarchy(const Frame& frame, size_t slot, const ExtractOptions& options) {
  if (options.overlays.hierarchy) {
    const size_t only = overlaid_slot(frame, options.selected);
    if (only == slot || only == no_index)
      return {options.hierarchy_kind(), options.overlays.hierarchy_level, only == slot};
  }
  if (const BodyNote* note = options.find_note(frame.body(slot).id))
    return {note->hierarchy, note->hierarchy_level, true};
  return {};
}

std::string_view ExtractOptions::hierarchy_kind() const {
  const std::string& kind =
      overlays.hierarchy_kind.empty() ? world_hierarchy : overlays.hierarchy_kind;
  const auto& drawn = drawn_hierarchies();
  return std::find(drawn.begin(), drawn.end(), kind) != drawn.end() ? std::string_view(kind)
                                                                    : "aabb";
}

const BodyNote* ExtractOptions::find_note(BodyId id) const {
  for (const BodyNote& note : notes)
    if (note.id == id) return &note;
  return nullptr;
}

bool add_hierarchy(const std::shared_ptr<const Shape>& shape, const Pose& pose, const Paint& paint,
                   const ShownHierarchy& shown, ShapeMeshes& meshes, RenderScene& out) {
  if (shown.kind.empty()) return false;
  const HierarchyView* view =
      meshes.hierarchies().view(shape, shown.kind, shown.level, shown.tinted);
  if (!view) return false;
  for (const HierarchyView::Wire& w : view->wires)
    out.lines.push_back({.a = pose.point(w.a).cast<float>(),
                         .b = pose.point(w.b).cast<float>(),
                         .colour = w.colour,
                         .width = 1.5f});
  if (!shown.tinted) return true;
  if (view->pieces.empty()) add_shape(shape, pose, paint, false, meshes, out);
  for (const HierarchyView::Piece& piece : view->pieces) {
    Paint own = paint;
    own.colour = 0.45f * paint.colour + 0.55f * piece.colour;
    out.instances.push_back(mesh_instance(piece.mesh, pose, Vec3::Ones(), own));
  }
  return true;
}

std::optional<int> hierarchy_depth(const Frame& frame, const ExtractOptions& options,
                                   ShapeMeshes& meshes) {
  std::optional<int> deepest;
  const size_t only = overlaid_slot(frame, options.selected);
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    if (frame.body(slot).id.is_null() || (only != no_index && slot != only)) continue;
    for (const BodyShape& part : frame.info(slot).shapes)
      if (const Hierarchy* h =
              meshes.hierarchies().find_or_make(part.shape, options.hierarchy_kind()))
        deepest = std::max(deepest.value_or(0), h->depth());
  }
  return deepest;
}

}  // namespace tumble
