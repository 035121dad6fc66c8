#include "engine/dynamics/realtime/swept_body.hpp"

#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <numbers>

namespace tumble {

bool winds(const RigidBody& body, double h) {
  return body.omega.norm() * h > tolerances::winding_of_half_turn * std::numbers::pi;
}

Motion tick_motion(const Pose& start, const RigidBody& body, double h) {
  Motion m = Motion::between(start, body.pose, 0, h);
  // The shorter rotation between the poses is wrong beyond half a turn; the angular velocity is
  // not.
  if (winds(body, h)) m.omega = body.omega;
  return m;
}

double turned_by(const Quat& from, const Quat& to, double radius) {
  const double sine = (to * from.conjugate()).vec().norm();
  return sine == 0 ? 0 : std::min(3.2 * sine, 2.0) * radius;
}

double way_of(const RigidBody& body, const Pose& start, double h) {
  const double straight = (body.pose.x - start.x).norm();
  if (winds(body, h)) return straight + 2 * body.bounding_radius;
  return straight + turned_by(start.q, body.pose.q, body.bounding_radius);
}

double unwatched(const RigidBody& body) {
  constexpr double share = tolerances::thin_of_size;
  const bool thin = body.inner_radius < share * body.bounding_radius &&
                    std::all_of(body.shapes.begin(), body.shapes.end(),
                                [](const BodyShape& s) { return !s.shape->is_mesh(); });
  return thin ? share * body.bounding_radius : foresight(body);
}

double unwatched(const RigidBody& body, const Shape& shape) {
  const double own =
      std::max(shape.inner_radius(), tolerances::foresight_of_radius * shape.bounding_radius());
  return std::min(unwatched(body), own);
}

void put_at(RigidBody& body, const Pose& pose) {
  if (!isotropic_inertia(body.inertia_body))
    body.omega = pose.direction(body.pose.inverse_direction(body.omega));
  body.pose = pose;
}

}  // namespace tumble
