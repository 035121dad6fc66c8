#include "viewer/interact/contact_picking.hpp"

#include <cmath>
#include <limits>

namespace tumble {

std::optional<ContactPick> pick_contact(const Frame& frame, const Camera& camera, double x,
                                        double y, double width, double height, double reach) {
  // Marks nearer to each other than this cannot be told apart [px].
  constexpr double same_place = 1.5;
  std::optional<ContactPick> best;
  double away = reach, depth = std::numeric_limits<double>::infinity();
  frame.for_contacts([&](const ContactFrame& c) {
    const Vec3 p = project(camera, c.x_world, width, height);
    const double d = std::hypot(p.x() - x, p.y() - y);
    if (!(p.z() > 0) || !(d <= reach)) return;
    if (best && !(d < away - same_place) && !(d < away + same_place && p.z() < depth)) return;
    best = ContactPick{c.a, c.b, c.x_world};
    away = d;
    depth = p.z();
  });
  return best;
}

}  // namespace tumble
