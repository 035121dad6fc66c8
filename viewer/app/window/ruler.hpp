#pragma once
#include "viewer/app/session/session.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/render/render_scene.hpp"
#include "viewer/ui/ruler_view.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Rulers between two points on bodies, and protractors at three (an arm, the corner, the other
/// arm). The points stick to their bodies, so that readings go on while these move. One whose
/// bodies are not all there, as before the first of them came into being, waits until they are.
class Ruler {
 public:
  /// More than these nobody tells apart in a picture.
  static constexpr size_t most = 8;

  /// One more point, where the picture of now was hit. True when it completes a reading.
  bool click(const SessionView& shown, const Pick& hit, bool angle);
  bool half_way() const { return !picked_.empty(); }
  bool full() const { return all_.size() >= most; }
  /// Forgets the points of a reading that is not complete.
  void cancel();
  void remove(size_t index);
  /// Another world is shown.
  void forget() { *this = Ruler{}; }
  /// Reads all for a frame.
  void update(const Frame& frame);
  const RulerView& view() const { return view_; }
  /// Points, lines, arcs and what they say, at the moment that is shown.
  void draw(const SessionView& shown, RenderScene& picture) const;

 private:
  struct Point {
    BodyId body;
    Vec3 x_body;       ///< in the frame of the body's centre of mass [m]
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

/// The angle between two arms [rad], 0 .. pi; exact to rounding for nearly parallel ones, too.
double angle_between(const Vec3& u, const Vec3& v);

}  // namespace tumble
