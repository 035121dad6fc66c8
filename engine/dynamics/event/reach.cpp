#include "engine/dynamics/event/reach.hpp"

#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/event/turning.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Radius for displacement by rotation: 0 for a ball about its centre of mass, which rotation
/// leaves unchanged.
double turning_radius(const RigidBody& b) {
  if (!std::isfinite(b.bounding_radius)) return 0;
  if (b.shapes.size() == 1 && b.shapes[0].shape->is_ball() && b.shapes[0].pose.x.isZero(0))
    return 0;
  return b.bounding_radius;
}

}  // namespace

double greatest_turn(const RigidBody& b, const Vec3& half, const Vec3& turn) {
  const double about = turn.norm() * turning_radius(b);
  if (!half.allFinite()) return about;
  const Vec3 t = turn.cwiseAbs();
  const Vec3 across(t.y() * half.z() + t.z() * half.y(), t.z() * half.x() + t.x() * half.z(),
                    t.x() * half.y() + t.y() * half.x());
  return std::min(about, across.norm());
}

double turning_speed_along(const RigidBody& b, const Vec3& half, const Vec3& normal) {
  const Vec3 across = b.pose.inverse_direction(normal.cross(b.omega));
  const double about = across.norm() * turning_radius(b);
  return half.allFinite() ? std::min(about, across.cwiseAbs().dot(half)) : about;
}

bool travels(const RigidBody& b) {
  return b.dynamic() || (b.type == BodyType::kinematic && !(b.v.isZero(0) && b.omega.isZero(0)));
}

double speed_bound(const RigidBody& b, double h) {
  double v = b.v.norm() + h * b.inverse_mass * b.force.norm();
  if (std::isfinite(b.bounding_radius)) v += b.omega.norm() * b.bounding_radius;
  return v;
}

std::vector<BodyReach> guess_reaches(std::span<const RigidBody> bodies, double gravity, double h) {
  std::vector<BodyReach> out(bodies.size());
  for (size_t i = 0; i < bodies.size(); ++i) {
    const RigidBody& b = bodies[i];
    out[i].start = b.pose;
    if (!travels(b)) continue;
    const double r = turning_radius(b);
    double distance =
        h * b.v.norm() + std::min(h * b.omega.norm(), 2.0) * r + tolerances::least_reach;
    if (std::isfinite(b.bounding_radius)) distance += tolerances::reach_of_size * b.bounding_radius;
    if (b.dynamic()) {
      const double turned = r * (b.inverse_inertia_world() * b.torque).norm();
      distance += h * h * (b.inverse_mass * b.force.norm() + turned + gravity);
    }
    out[i].distance = distance;
  }
  return out;
}

BodyReach guess_reach(const RigidBody& b, const Vec3& half, double gravity, double h, double tick) {
  BodyReach out;
  out.start = b.pose;
  out.half = half;
  if (!travels(b)) return out;
  const double r = turning_radius(b);
  const auto speed = [&](const Vec3& turn) {
    return greatest_turn(b, half, b.pose.inverse_direction(turn));
  };
  out.distance =
      h * b.v.norm() + std::min(h * speed(b.omega), 2 * r) + h / tick * tolerances::least_reach;
  if (std::isfinite(b.bounding_radius))
    out.distance += h / tick * tolerances::reach_of_size * b.bounding_radius;
  if (b.dynamic())
    out.distance +=
        h * h *
        (b.inverse_mass * b.force.norm() + speed(b.inverse_inertia_world() * b.torque) + gravity);
  return out;
}

Vec3 box_about(const RigidBody& b) {
  Vec3 half = Vec3::Zero();
  for (const BodyShape& s : b.shapes) {
    if (s.shape->is_ball() && b.shapes.size() == 1 && s.pose.x.isZero(0)) return half;
    const Aabb box = s.shape->bounds(s.pose);
    half = half.cwiseMax(box.min.cwiseAbs()).cwiseMax(box.max.cwiseAbs());
  }
  return half;
}

double displacement_bound(const RigidBody& b, const BodyReach& reach) {
  if (reach.half.allFinite()) {
    // |R r - r| = 2 sin(angle / 2) |axis x r|
    const Quat turned = reach.start.q.conjugate() * b.pose.q;
    return (b.pose.x - reach.start.x).norm() + 2 * greatest_turn(b, reach.half, turned.vec());
  }
  const double cosine = std::fabs(b.pose.q.coeffs().dot(reach.start.q.coeffs()));
  const double chord = 2 * std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return (b.pose.x - reach.start.x).norm() + chord * turning_radius(b);
}

void reach_proxies(std::span<const RigidBody> bodies, std::span<const BodyReach> reaches,
                   ProxySet& out) {
  out.proxies.clear();
  out.refs.clear();
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    const RigidBody& b = bodies[i];
    for (uint32_t s = 0; s < b.shapes.size(); ++s) {
      const Aabb now = b.shapes[s].shape->bounds(b.pose * b.shapes[s].pose);
      out.proxies.push_back({now.inflated(reaches[i].distance), travels(b)});
      out.refs.push_back({i, s});
    }
  }
}

}  // namespace tumble
