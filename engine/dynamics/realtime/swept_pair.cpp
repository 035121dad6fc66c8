#include "engine/dynamics/realtime/swept_pair.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tumble {
namespace {

constexpr double no_contact_time = std::numeric_limits<double>::infinity();

/// The section [t0, t1] of the motion of a shape on a body that stops at time `stop`, which is not
/// inside the section; `offset` is the shape's frame relative to the body's centre.
Motion motion_section(const Motion& m, double stop, double t0, double t1, const Pose& offset) {
  Motion out = t0 < stop ? m : Motion::at_rest(m.carrier(stop), t0, t1);
  if (t0 < stop) out.start = m.carrier(t0);
  out.t0 = t0;
  out.t1 = t1;
  out.offset = offset;
  return out;
}

/// The relation of two shapes at one time.
struct Look {
  bool touch = false;
  double depth = 0;    ///< greatest overlap; 0 when they are apart [m]
  double closing = 0;  ///< bound on the rate at which it grows [m/s]
  /// Where the overlap is deepest, or they are nearest.
  Vec3 at = Vec3::Zero(), normal = Vec3::UnitY();
};

/// The motion of a pair through the tick.
class Sweep {
 public:
  Sweep(const SweptPair& pair, double h) : p_(pair), h_(h) {
    see(0);
    limit_ = std::max(now_.depth + p_.growth, p_.allowed);
  }

  SweptStop stop() {
    while (t_ < h_ && !is_left() && !stop_requested()) {
      const double end = section_end();
      const TimeOfContact hit = next_contact(end);
      const bool ahead = hit.hit() && hit.time > t_;
      // If no time of contact is found, the pair is tested like a touching one.
      const bool timed = ahead || hit.status == TimeOfContactStatus::separated;
      if (!timed && !now_.touch) {
        now_.touch = true;
        now_.closing = fastest();
      }
      if (is_left()) break;
      const double until = ahead ? hit.time : end;
      if (!now_.touch) {
        if (until >= h_) break;
        see(until);
      } else if (!walk(until)) {
        return stop_;
      }
      if (!ahead || t_ < until) continue;
      if (approach(hit) * (h_ - t_) > p_.allowed) return {t_};
      // A shallow contact does not stop the pair, which is then tested like a touching one.
      now_.touch = true;
      now_.closing = std::max(now_.closing, closing_along(hit.normal, hit.on_a));
    }
    return {};
  }

 private:
  bool moves_a() const { return t_ < p_.stop_a; }
  bool moves_b() const { return t_ < p_.stop_b; }
  bool is_left() const { return now_.touch && !p_.watch_touching; }

  TimeOfContact next_contact(double end) const {
    if (now_.touch && !p_.time_touching) return {};
    return time_of_contact(p_.a, motion_section(p_.motion_a, p_.stop_a, t_, end, p_.offset_a), p_.b,
                           motion_section(p_.motion_b, p_.stop_b, t_, end, p_.offset_b),
                           p_.tolerance, p_.contact_time);
  }

  double section_end() const {
    double end = h_;
    for (const double stop : {p_.stop_a, p_.stop_b})
      if (stop > t_) end = std::min(end, stop);
    return end;
  }

  /// Bound on the rate at which the overlap along `n` grows before the next computed contact [m/s].
  double closing_along(const Vec3& n, const Vec3& at) const {
    if (!p_.time_touching) return fastest();
    const auto along = [&](const Motion& m, const Vec3& dir, double swing, double lever) {
      const double turn = std::min(dir.cross(m.omega).norm(), swing);
      const double all = dir.dot(m.velocity) + (turn > 0 ? turn * lever : 0);
      if (!std::isfinite(p_.reach)) return all;
      const Vec3 here = m.velocity + m.omega.cross(at - m.carrier(t_).x);
      return std::min(all, dir.dot(here) + turn * p_.reach);
    };
    return (moves_a() ? along(p_.motion_a, n, p_.swing_a, p_.lever_a) : 0) +
           (moves_b() ? along(p_.motion_b, -n, p_.swing_b, p_.lever_b) : 0);
  }
  double fastest() const {
    return (moves_a() ? p_.motion_a.speed_bound(p_.lever_a) : 0) +
           (moves_b() ? p_.motion_b.speed_bound(p_.lever_b) : 0);
  }
  /// Approach speed along the normal of the points that meet [m/s].
  double approach(const TimeOfContact& hit) const {
    const auto velocity = [&](const Motion& m, const Vec3& x) {
      return (m.velocity + m.omega.cross(x - m.carrier(t_).x));
    };
    return (moves_a() ? hit.normal.dot(velocity(p_.motion_a, hit.on_a)) : 0) -
           (moves_b() ? hit.normal.dot(velocity(p_.motion_b, hit.on_b)) : 0);
  }

  /// Advances to time t and runs the narrow phase.
  void see(double t) {
    t_ = t;
    now_ = {};
    manifolds_.clear();
    double nearest = no_contact_time;
    p_.narrow_phase(p_.a, p_.motion_a.carrier(std::min(t, p_.stop_a)) * p_.offset_a, p_.b,
                    p_.motion_b.carrier(std::min(t, p_.stop_b)) * p_.offset_b, 2 * p_.tolerance,
                    manifolds_);
    for (const Manifold& m : manifolds_) {
      now_.touch = true;
      for (int i = 0; i < m.count; ++i) {
        const ManifoldPoint& p = m.points[size_t(i)];
        now_.closing = std::max(now_.closing, closing_along(m.normal, p.x_world));
        if (p.gap >= nearest) continue;
        nearest = p.gap;
        now_.depth = std::max(-p.gap, 0.0);
        now_.at = p.x_world;
        now_.normal = m.normal;
      }
    }
  }

  /// Advances while the two touch, at most to `until`; false when they must be stopped now.
  bool walk(double until) {
    while (t_ < until && now_.touch && !stop_requested()) {
      stop_ = {t_, now_.depth > 0, now_.at, now_.normal};
      if (++looks_ > tolerances::most_looks) return false;
      const double far =
          now_.closing > 0 ? tolerances::look_step * p_.allowed / now_.closing : no_contact_time;
      see(std::min(until, t_ + far));
      if (now_.depth <= limit_) continue;
      stop_ = {stop_.time, true, now_.at, now_.normal};
      return false;
    }
    return true;
  }

  const SweptPair& p_;
  double h_, limit_ = 0;
  double t_ = 0;
  int looks_ = 0;
  Look now_;
  SweptStop stop_;
  std::vector<Manifold> manifolds_;
};

}  // namespace

SweptStop swept_stop(const SweptPair& pair, double h) {
  return Sweep(pair, h).stop();
}

void stop_approach(RigidBody& a, RigidBody& b, const Vec3& at, const Vec3& normal) {
  const double speed = normal.dot(a.velocity_at(at) - b.velocity_at(at));
  if (!(speed > 0)) return;
  const auto gives_way = [](const RigidBody& body) { return body.dynamic() && body.awake(); };
  const auto turn = [&](const RigidBody& body) {  // change of angular velocity per impulse
    return (body.inverse_inertia_world() * (at - body.pose.x).cross(normal));
  };
  double mobility = 0;
  for (const RigidBody* body : {&a, &b})
    if (gives_way(*body))
      mobility += body->inverse_mass + normal.dot(turn(*body).cross(at - body->pose.x));
  if (!(mobility > 0)) return;
  const double impulse = speed / mobility;
  for (RigidBody* body : {&a, &b}) {
    if (!gives_way(*body)) continue;
    const double sign = body == &a ? -1 : 1;
    const Vec3 w = turn(*body);
    body->v += sign * impulse * body->inverse_mass * normal;
    body->omega += sign * impulse * w;
  }
}

}  // namespace tumble
