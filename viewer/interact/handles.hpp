#pragma once
#include "engine/math/types.hpp"
#include "viewer/render/camera.hpp"

#include <cstdint>
#include <optional>

namespace tumble {

struct RenderScene;

/// What the handles at the selected bodies do.
enum class HandleKind : uint8_t { none, move, turn, scale };

/// How handles stand, and in which steps they go where they snap.
struct HandleSettings {
  HandleKind kind = HandleKind::none;
  bool own_axes = false;    ///< along the axes of the main body; else along the world's
  bool snap = false;        ///< in the steps below; Ctrl while dragging does the opposite
  double step = 0.1;        ///< [m]
  double step_deg = 15;     ///< [degrees]
  double step_scale = 0.1;  ///< of the size at the start [-]
};

/// Where bodies are asked to go: a body at `pose` comes to moved(pose), and lengths grow `scale`
/// times, all of them or those along one axis.
struct Displacement {
  Vec3 pivot = Vec3::Zero();         ///< stays where it is but for `shift`
  Vec3 shift = Vec3::Zero();         ///< [m]
  Quat turn = Quat::Identity();      ///< about the pivot
  double scale = 1;                  ///< from the pivot [-]
  std::optional<Vec3> scale_axis{};  ///< unit; none: in every direction

  Pose moved(const Pose& pose) const;
};

/// Handles in a picture by which bodies are moved, turned and scaled: three arms or rings along the
/// axes of a frame, squares between the arms for planes, and a middle. They have the same size on
/// the screen at every distance. Knows nothing of bodies.
class Handles {
 public:
  /// What is looked at: the camera and the size of the picture in the units of the pointer.
  struct View {
    Camera camera;
    double width = 1, height = 1;
  };
  /// Arms and rings along x, y, z; squares across x, y, z; what is in the middle.
  enum class Part : uint8_t { none, x, y, z, across_x, across_y, across_z, middle };

  /// Which handle a point of the picture is on; of several the nearest.
  static Part hit(HandleKind kind, const Pose& frame, const View& view, double x, double y);
  /// A point of a handle in the world, to take hold of it there.
  static Vec3 grip(HandleKind kind, const Pose& frame, Part part, const View& view);
  /// Takes hold of a handle at a point of the picture.
  void begin(const HandleSettings& settings, const Pose& frame, Part part, const View& view,
             double x, double y);
  /// Where the pointer asks to go, from where things were at the beginning; nothing where its ray
  /// does not say (it looks along the arm).
  std::optional<Displacement> drag(const View& view, double x, double y, bool snap) const;
  void end() { part_ = Part::none; }
  bool active() const { return part_ != Part::none; }
  Part part() const { return part_; }

  /// The handles of a frame, the one in use (or under the pointer) lit.
  static void draw(HandleKind kind, const Pose& frame, Part lit, const View& view,
                   RenderScene& out);

 private:
  std::optional<Displacement> move(const View& view, double x, double y, bool snap) const;
  std::optional<Displacement> turn(const View& view, double x, double y, bool snap) const;
  std::optional<Displacement> scale(const View& view, double x, double y, bool snap) const;

  HandleSettings settings_;
  Pose frame_;
  Part part_ = Part::none;
  double arm_ = 1;  ///< length of an arm at the beginning [m]
  double x_ = 0, y_ = 0;
  Vec3 begin_ = Vec3::Zero();  ///< the point that was taken
};

}  // namespace tumble
