#include "engine/collision/time_of_contact.hpp"

#include "engine/collision/continuous/contact_answer.hpp"
#include "engine/collision/continuous/moving_pair.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

int order(const Shape& s) {
  return int(s.family());
}

bool sound_motion(const Motion& m) {
  const auto unit = [](const Quat& q) { return std::fabs(q.squaredNorm() - 1) < 1e-6; };
  return m.start.x.allFinite() && m.velocity.allFinite() && m.omega.allFinite() &&
         m.offset.x.allFinite() && std::isfinite(m.t0) && std::isfinite(m.t1) && m.t0 <= m.t1 &&
         unit(m.start.q) && unit(m.offset.q);
}

/// Greatest distance of any relevant point from the world's origin or from its centre of rotation.
double farthest(const Shape& s, const Motion& m) {
  const double reach = s.is_half_space() ? 0 : s.bounding_radius();
  const double duration = m.t1 - m.t0;
  return (m.start.x.norm() + m.velocity.norm() * duration) +
         (m.offset.x.norm() + reach) * (1 + m.omega.norm() * duration);
}

TimeOfContact answer_of(const ContactTimeMethod* asked, const MovingPair& p) {
  const ContactTimeMethod& automatic = all_contact_time_methods().front();
  const ContactTimeMethod& method = asked && asked->applies(p) ? *asked : automatic;
  TimeOfContact r = method.find(p);
  if (r.method.empty()) r.method = method.name;
  return r;
}

void set_features(TimeOfContact& r, const MovingPair& p) {
  const auto on = [&](const Shape& s, const Motion& m, const Vec3& x, uint32_t triangle) {
    return s.feature_at(m.pose(r.time).inverse_point(x), triangle);
  };
  r.features = {on(p.a, p.motion_a, r.on_a, r.triangle_a),
                on(p.b, p.motion_b, r.on_b, r.triangle_b)};
}

}  // namespace

std::string_view to_string(TimeOfContactStatus status) {
  switch (status) {
    case TimeOfContactStatus::separated:
      return "separated";
    case TimeOfContactStatus::contact:
      return "contact";
    case TimeOfContactStatus::initially_overlapping:
      return "initially_overlapping";
    case TimeOfContactStatus::max_iterations:
      return "max_iterations";
    case TimeOfContactStatus::invalid:
      return "invalid";
  }
  return "?";
}

TimeOfContact time_of_contact(const Shape& a, const Motion& motion_a, const Shape& b,
                              const Motion& motion_b, double tolerance,
                              const TimeOfContactOptions& options) {
  const bool sound = tolerance > 0 && std::isfinite(tolerance) && sound_motion(motion_a) &&
                     sound_motion(motion_b) && motion_a.t0 == motion_b.t0 &&
                     motion_a.t1 == motion_b.t1;
  if (!sound) {
    TimeOfContact r;
    r.status = TimeOfContactStatus::invalid;
    r.time = r.low = r.high = std::isfinite(motion_a.t0) ? motion_a.t0 : 0;
    return r;
  }
  if (order(a) == 0 && order(b) == 0) {
    TimeOfContact r = separated_until(motion_a.t1);
    r.method = all_contact_time_methods().front().name;
    r.certified = true;
    return r;
  }
  if (order(a) > order(b)) {
    return exchanged(time_of_contact(b, motion_b, a, motion_a, tolerance, options));
  }
  const MovingPair pair{a, motion_a, b, motion_b, tolerance, options};
  TimeOfContact r = answer_of(options.method, pair);
  const bool touches = r.hit() || r.status == TimeOfContactStatus::initially_overlapping;
  if (touches) set_features(r, pair);
  const double rounding = 0x1p-48 * (farthest(a, motion_a) + farthest(b, motion_b));
  r.certified = 0.25 * tolerance > rounding;
  return r;
}

}  // namespace tumble
