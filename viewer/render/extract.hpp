#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/overlays.hpp"
#include "viewer/render/render_scene.hpp"

#include <map>
#include <memory>

namespace tumble {

/// Triangles of collision shapes as drawable meshes, made once per shape. Keeps the shapes of
/// living bodies only, after prune().
class ShapeMeshes {
 public:
  /// The mesh of a hull or triangle mesh; null for shapes that have a built-in mesh, and for hulls
  /// that cannot be made.
  MeshRef find_or_make(const std::shared_ptr<const Shape>& shape);
  /// Forgets shapes that nobody else uses any more.
  void prune();
  size_t size() const { return meshes_.size(); }

 private:
  struct Entry {
    std::shared_ptr<const Shape> shape;
    MeshRef mesh;
  };
  std::map<const Shape*, Entry> meshes_;
};

struct ExtractOptions {
  Overlays overlays;
  BodyId selected;  ///< drawn with an outline; null: none
};

/// The only function that knows both the simulation and the picture: fills `out` (content only;
/// camera, light and look stay) with the moment `s` of the way from one frame to the next. A half
/// space that faces straight up is not drawn but sets the height of the ground. Takes no GL.
void extract(const Frame& from, const Frame& to, double s, const ExtractOptions& options,
             ShapeMeshes& meshes, RenderScene& out);

/// The paint of a shape; `time` moves the stripes of conveyor belts [s].
Paint paint_of(const Look& look, const Material& material, double time);

/// Instances of one shape: the part of extract() that a preview of a mesh also uses.
void add_shape(const std::shared_ptr<const Shape>& shape, const Pose& pose, const Paint& paint,
               bool selected, ShapeMeshes& meshes, RenderScene& out);

/// The overlays and springs alone (extract_overlays.cpp); `poses` by body slot.
void add_overlays(const Frame& frame, const std::vector<Pose>& poses, const Overlays& overlays,
                  RenderScene& out);

/// The cells or boxes that the broad phase of the world makes of these poses (extract_grid.cpp).
void add_grid(const Frame& frame, const std::vector<Pose>& poses, RenderScene& out);

/// Wires of a shape's true geometry (extract_wires.cpp).
void add_wires(const Shape& shape, const Pose& pose, const Vec4f& colour, RenderScene& out);

}  // namespace tumble
