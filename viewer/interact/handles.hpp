#pragma once
#include "engine/math/types.hpp"
#include "viewer/render/camera.hpp"

#include <cstdint>
#include <optional>

namespace tumble {

struct RenderScene;

/// Kind of handles shown at the selected bodies.
enum class HandleKind : uint8_t { none, move, turn, scale };

/// Orientation of the handles, and the steps to which they snap: places on a grid of the world, or
/// displacements along a body's own axes.
struct HandleSettings {
  HandleKind kind = HandleKind::none;
  bool own_axes = false;    ///< along the axes of the primary body, otherwise along the world's
  bool snap = false;        ///< use the steps below; holding Ctrl while dragging inverts this
  double step = 0.1;        ///< [m]
  double step_deg = 15;     ///< [degrees]
  double step_scale = 0.1;  ///< in units of the initial size [-]
};

/// A rigid motion with scaling, requested for bodies: a body at `pose` moves to moved(pose), and
/// lengths are multiplied by `scale`, all of them or those along one axis.
struct Displacement {
  Vec3 pivot = Vec3::Zero();         ///< fixed point, apart from `shift`
  Vec3 shift = Vec3::Zero();         ///< [m]
  Quat turn = Quat::Identity();      ///< about the pivot
  double scale = 1;                  ///< about the pivot [-]
  std::optional<Vec3> scale_axis{};  ///< unit vector; none: all directions

  Pose moved(const Pose& pose) const;
  /// Whether it leaves every body where it is.
  bool is_null() const;
  bool turns() const;
};

/// Handles in a picture for moving, rotating and scaling: three arms or rings along the axes of a
/// frame, squares between the arms for planes, and a centre. They have the same size on the screen
/// at every distance. Independent of bodies.
class Handles {
 public:
  /// The camera, and the size of the picture in the units of the pointer.
  struct View {
    Camera camera;
    double width = 1, height = 1;
  };
  /// Arms and rings for x, y, z; squares perpendicular to x, y, z; the centre.
  enum class Part : uint8_t { none, x, y, z, across_x, across_y, across_z, middle };

  /// The handle at a point of the picture; if there are several, the nearest.
  static Part hit(HandleKind kind, const Pose& frame, const View& view, double x, double y);
  /// A point of a handle in the world, by which scripts can grab it.
  static Vec3 grip(HandleKind kind, const Pose& frame, Part part, const View& view);
  /// Begins a drag of a handle at a point of the picture.
  void begin(const HandleSettings& settings, const Pose& frame, Part part, const View& view,
             double x, double y);
  /// The displacement since the begin of the drag; empty if the pointer's ray does not determine
  /// one (it is nearly parallel to the arm).
  std::optional<Displacement> drag(const View& view, double x, double y, bool snap) const;
  void end() { part_ = Part::none; }
  bool active() const { return part_ != Part::none; }
  Part part() const { return part_; }

  /// Draws the handles of a frame; `lit` is the one in use or under the pointer.
  static void draw(HandleKind kind, const Pose& frame, Part lit, const View& view,
                   RenderScene& out);

 private:
  std::optional<Displacement> move(const View& view, double x, double y, bool snap) const;
  std::optional<Displacement> turn(const View& view, double x, double y, bool snap) const;
  std::optional<Displacement> scale(const View& view, double x, double y, bool snap) const;

  HandleSettings settings_;
  Pose frame_;
  Part part_ = Part::none;
  double arm_ = 1;  ///< length of an arm at the begin of the drag [m]
  double x_ = 0, y_ = 0;
  Vec3 begin_ = Vec3::Zero();  ///< point that was grabbed
};

}  // namespace tumble
