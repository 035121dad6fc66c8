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

/// What a scene wants to be said of one body.
struct BodyNote {
  BodyId id;
  std::string label;      ///< text above it
  std::string hierarchy;  ///< kind whose volumes are drawn around its meshes; "": none
  int hierarchy_level = 0;
};

struct ExtractOptions {
  Overlays overlays;
  BodyId selected;                    ///< drawn with an outline; null: none
  std::vector<BodyId> also_selected;  ///< likewise
  std::vector<BodyNote> notes;
  std::string world_hierarchy;                ///< WorldSettings::hierarchy
  std::optional<MicroscopeSetup> microscope;  ///< drawn in place of its two bodies
  std::optional<int> microscope_step;         ///< instead of the one that is due
  /// What the world said, for algorithms that ask it (ask_world).
  std::shared_ptr<const MicroscopeAnswer> microscope_said;
  bool microscope_plate = true;  ///< with its words
  /// The tick before the one that is shown, for what says how things change; null: that between
  /// which and the shown one the picture is, where it is the one before.
  std::shared_ptr<const Frame> before;

  /// The kind that the overlay shows: the one chosen, or the world's where that has volumes.
  std::string_view hierarchy_kind() const;
  const BodyNote* find_note(BodyId id) const;
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

/// The overlays and springs alone (extract_overlays.cpp); `poses` by body slot, `before` the frame
/// of the tick before or null.
void add_overlays(const Frame& frame, const Frame* before, const std::vector<Pose>& poses,
                  const Overlays& overlays, RenderScene& out);

/// The cells or boxes that the broad phase of the world makes of these poses (extract_grid.cpp).
void add_grid(const Frame& frame, const std::vector<Pose>& poses, RenderScene& out);

/// Outlines of the sensors and what they say (extract_sensors.cpp).
void add_sensors(const Frame& frame, const std::vector<Pose>& poses, RenderScene& out);

/// Arrows of the fields where things are: flows, and accelerations (extract_fields.cpp).
void add_fields(const Frame& frame, const std::vector<Pose>& poses, RenderScene& out);

/// Which level of which hierarchy is drawn around a body's meshes; kind "": none.
struct ShownHierarchy {
  std::string_view kind;
  int level = 0;
  bool tinted = false;  ///< triangles in the colours of the volumes that hold them
};
/// The overlay's for the selected body, and for all when no mesh is selected; else the note's.
ShownHierarchy shown_hierarchy(const Frame& frame, size_t slot, const ExtractOptions& options);

/// Volumes of a level, and with `tinted` the mesh in pieces, each with a colour mixed from
/// `paint`'s and that of the volume that holds it (extract_hierarchy.cpp). False, and nothing
/// added, for shapes that have no hierarchy.
bool add_hierarchy(const std::shared_ptr<const Shape>& shape, const Pose& pose, const Paint& paint,
                   const ShownHierarchy& shown, ShapeMeshes& meshes, RenderScene& out);

/// Depth of the deepest hierarchy that the overlay shows or would show; nothing without meshes.
std::optional<int> hierarchy_depth(const Frame& frame, const ExtractOptions& options,
                                   ShapeMeshes& meshes);

/// Wires of a shape's true geometry (extract_wires.cpp).
void add_wires(const Shape& shape, const Pose& pose, const Vec4f& colour, RenderScene& out);

}  // namespace tumble
