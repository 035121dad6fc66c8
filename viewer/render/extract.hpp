#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/hierarchy_views.hpp"
#include "viewer/render/microscope_view.hpp"
#include "viewer/render/overlays.hpp"
#include "viewer/render/render_scene.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Cache of the triangles of collision shapes as drawable meshes, each made once. prune() drops
/// shapes that no longer exist.
class ShapeMeshes {
 public:
  /// The mesh of a hull or triangle mesh; null for shapes that have a built-in mesh, and for hulls
  /// that cannot be computed.
  MeshRef find_or_make(const std::shared_ptr<const Shape>& shape);
  /// Drops the meshes of shapes that nothing else refers to.
  void prune();
  size_t size() const { return meshes_.size(); }
  HierarchyViews& hierarchies() { return hierarchies_; }
  MicroscopeView& microscope() { return microscope_; }
  const MicroscopeView& microscope() const { return microscope_; }

 private:
  struct Entry {
    std::shared_ptr<const Shape> shape;
    MeshRef mesh;
  };
  std::map<const Shape*, Entry> meshes_;
  HierarchyViews hierarchies_;
  MicroscopeView microscope_;
};

/// How the scene file wants one body to be annotated.
struct BodyNote {
  BodyId id;
  std::string label;      ///< text above it
  std::string hierarchy;  ///< kind of hierarchy whose bounding volumes are drawn around its meshes;
                          ///< "": none
  int hierarchy_level = 0;
};

struct ExtractOptions {
  Overlays overlays;
  BodyId selected;                    ///< drawn with an outline; null: none
  std::vector<BodyId> also_selected;  ///< more selected bodies, drawn with an outline too
  std::vector<BodyNote> notes;
  std::string world_hierarchy;                ///< WorldSettings::hierarchy
  std::optional<MicroscopeSetup> microscope;  ///< its animation is drawn in place of its two bodies
  std::optional<int> microscope_step;  ///< step of the animation to show; without it the one due at
                                       ///< the time of the frame
  /// What the world answered for algorithms that need the world (ask_world).
  std::shared_ptr<const MicroscopeAnswer> microscope_said;
  bool microscope_plate = true;  ///< whether the microscope's text and diagram are drawn
  /// The frame of the tick before the shown one, for quantities that are rates of change. Null: the
  /// picture lies between `from` and `to`, and `from` is taken if it is the tick before.
  std::shared_ptr<const Frame> before;

  /// The kind of hierarchy that the overlay shows: the chosen one, else the world's own if that has
  /// volumes.
  std::string_view hierarchy_kind() const;
  const BodyNote* find_note(BodyId id) const;
};

/// Fills `out` with the contents of a picture at the fraction `s` of the way from frame `from` to
/// frame `to`; camera, light and look of `out` stay. This is the only function that knows both
/// simulation and picture; it makes no graphics calls. A half space that faces straight up is not
/// drawn but sets the height of the ground.
void extract(const Frame& from, const Frame& to, double s, const ExtractOptions& options,
             ShapeMeshes& meshes, RenderScene& out);

/// The paint of a shape; `time` moves the stripes of conveyor belts [s].
Paint paint_of(const Look& look, const Material& material, double time);

/// Adds the instances of one shape; extract() and previews of meshes use it.
void add_shape(const std::shared_ptr<const Shape>& shape, const Pose& pose, const Paint& paint,
               bool selected, ShapeMeshes& meshes, RenderScene& out);

/// Adds overlays and springs only (extract_overlays.cpp); `poses` are by body slot, `before` is the
/// frame of the tick before or null.
void add_overlays(const Frame& frame, const Frame* before, const std::vector<Pose>& poses,
                  const Overlays& overlays, RenderScene& out);

/// Adds the cells or boxes that the world's broad phase would make for these poses
/// (extract_grid.cpp).
void add_grid(const Frame& frame, const std::vector<Pose>& poses, RenderScene& out);

/// Adds the outlines of sensors and their readings (extract_sensors.cpp).
void add_sensors(const Frame& frame, const std::vector<Pose>& poses, RenderScene& out);

/// Adds arrows of force fields, sampled where the affected things are: flow velocities and
/// accelerations (extract_fields.cpp).
void add_fields(const Frame& frame, const std::vector<Pose>& poses, RenderScene& out);

/// Which level of which hierarchy is drawn around a body's meshes; kind "" means none.
struct ShownHierarchy {
  std::string_view kind;
  int level = 0;
  bool tinted = false;  ///< triangles are drawn in the colour of the volume that contains them
};
/// The hierarchy to draw for the body in `slot`: that of the overlay for the selected body, or for
/// all bodies if none with a mesh is selected; otherwise that of the body's note.
ShownHierarchy shown_hierarchy(const Frame& frame, size_t slot, const ExtractOptions& options);

/// Adds the bounding volumes of one level. If `tinted`, also the mesh in pieces, each coloured by a
/// mixture of `paint` and the colour of its volume (extract_hierarchy.cpp). Returns false and adds
/// nothing if the shape has no hierarchy.
bool add_hierarchy(const std::shared_ptr<const Shape>& shape, const Pose& pose, const Paint& paint,
                   const ShownHierarchy& shown, ShapeMeshes& meshes, RenderScene& out);

/// Depth of the deepest hierarchy among those the overlay would show; nothing if there are no
/// meshes.
std::optional<int> hierarchy_depth(const Frame& frame, const ExtractOptions& options,
                                   ShapeMeshes& meshes);

/// Adds line drawings of the exact geometry of a shape (extract_wires.cpp).
void add_wires(const Shape& shape, const Pose& pose, const Vec4f& colour, RenderScene& out);

}  // namespace tumble
