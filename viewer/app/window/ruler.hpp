#pragma once
#include "viewer/app/session/session.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/render/render_scene.hpp"
#include "viewer/ui/ruler_view.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Rulers between two points on bodies, and protractors at three points (end of an arm, vertex, end
/// of the other arm). The points are fixed to their bodies and move with them. A reading for which
/// not all bodies exist (yet) waits until they do.
class Ruler {
 public:
  /// Greatest number of readings; more could not be told apart in a picture.
  static constexpr size_t most = 8;

  /// Adds a point where the picture was hit. True if it completes a reading.
  bool click(const SessionView& shown, const Pick& hit, bool angle);
  bool half_way() const { return !picked_.empty(); }
  bool full() const { return all_.size() >= most; }
  /// Drops the points of an incomplete reading.
  void cancel();
  void remove(size_t index);
  /// To be called when another world is shown.
  void forget() { *this = Ruler{}; }
  /// Updates all readings for a frame.
  void update(const Frame& frame);
  const RulerView& view() const { return view_; }
  /// Draws points, lines, arcs and values at the moment shown.
  void draw(const SessionView& shown, RenderScene& picture) const;

 private:
  struct Point {
    BodyId body;
    Vec3 x_body;       ///< in the body frame, relative to the centre of mass [m]
    std::string name;  ///< of the body
  };
  using Points = std::vector<Point>;
  static std::optional<std::vector<Vec3>> places(const Points& points, const Frame& frame);
  static std::optional<double> read(const Points& points, const Frame& frame);
  RulerReading reading(const Points& points);

  std::vector<Points> all_;
  Points picked_;
  RulerView view_;
  int made_ = 0;
};

/// The angle between two vectors [rad], 0 .. pi; accurate also for nearly parallel ones.
double angle_between(const Vec3& u, const Vec3& v);

}  // namespace tumble
