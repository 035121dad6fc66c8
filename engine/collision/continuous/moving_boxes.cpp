#include "engine/collision/continuous/moving_boxes.hpp"

#include "engine/math/rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace tumble {
namespace {

constexpr double box_half_ulp = 0x1p-53;
constexpr int most_box_steps = 4096;
constexpr int box_axes = 15;
/// Edges at a smaller sine count as parallel: face axes are then as good, up to this share of the
/// size.
constexpr double parallel_box_sine = 1e-13;

/// The boxes at one time: half axes, vector from A's centre to B's, and the gap along each axis.
struct BoxMoment {
  double t = 0;       ///< since the beginning [s]
  Mat3 a, b;          ///< half axes in columns, world
  Vec3 arm_a, arm_b;  ///< from the carriers to the centres
  Vec3 between;
  std::array<Vec3, box_axes> axis;      ///< unit, from A to B; zero where undefined
  std::array<double, box_axes> gap{};   ///< along it
  std::array<double, box_axes> sine{};  ///< of the edges
  int best = 0;
};

class BoxMarch {
 public:
  BoxMarch(const MovingBox& a, const MovingBox& b)
      : a_(a), b_(b), duration_(a.motion.t1 - a.motion.t0) {
    apart_ = b.motion.start.x - a.motion.start.x;
    velocity_ = b.motion.velocity - a.motion.velocity;
    lever_a_ = a.motion.lever(a.half_extents.norm());
    lever_b_ = b.motion.lever(b.half_extents.norm());
    size_ = apart_.norm() + duration_ * velocity_.norm() + lever_a_ + lever_b_;
    spin_a_ = a.motion.omega.norm();
    spin_b_ = b.motion.omega.norm();
    // Rounding of positions: a few units; of orientations: a few, and that of the angle itself.
    rounding_ =
        box_half_ulp * (64 * size_ + 8 * duration_ * (spin_a_ * lever_a_ + spin_b_ * lever_b_));
  }

  std::optional<MovingBoxContact> run() const {
    BoxMoment now = moment(0);
    double step = duration_;
    for (int k = 0; k < most_box_steps; ++k) {
      const double room = now.gap[size_t(now.best)] - rounding_;
      if (!(room > 2 * rounding_)) return in_doubt(now);
      if (!(now.t < duration_)) return std::nullopt;
      const double left = duration_ - now.t;
      step = std::min(step, left);
      if (step < 0x1p-50 * duration_ && step < left) return in_doubt(now);
      const BoxMoment next = moment(step >= left ? duration_ : now.t + step);
      if (free_between(now, next)) {
        const double done = next.t - now.t;
        now = next;
        step = std::min(std::max(towards_contact(now), 0.99 * sure_step(now)), 8 * done);
        continue;
      }
      const double sure = 0.99 * sure_step(now);
      // Before the contact the arcs may still be too wide for the remaining gap.
      step =
          step <= sure ? 0.25 * step : std::max(sure, std::min(0.25 * step, towards_contact(now)));
    }
    return contact_between(now, duration_, false);
  }

 private:
  BoxMoment moment(double t) const {
    BoxMoment m;
    m.t = t;
    place(a_, t, m.a, m.arm_a);
    place(b_, t, m.b, m.arm_b);
    m.between = (apart_ + t * velocity_) + (m.arm_b - m.arm_a);
    const Mat3 ra = rotation(a_, t), rb = rotation(b_, t);
    for (int i = 0; i < 3; ++i) {
      set_axis(m, i, ra.col(i), 1);
      set_axis(m, 3 + i, rb.col(i), 1);
      for (int j = 0; j < 3; ++j) {
        Vec3 w = ra.col(i).cross(rb.col(j));
        const double sine = w.norm();
        if (sine > parallel_box_sine) {
          w /= sine;
          w -= w.dot(ra.col(i)) * ra.col(i);
          w.normalize();
        } else {
          w.setZero();
        }
        set_axis(m, 6 + 3 * i + j, w, sine);
      }
    }
    for (int k = 1; k < box_axes; ++k) {
      if (m.gap[size_t(k)] > m.gap[size_t(m.best)]) m.best = k;
    }
    return m;
  }
  static Mat3 rotation(const MovingBox& box, double t) {
    const Motion& m = box.motion;
    return (integrate_rotation(m.start.q, m.omega, t) * m.offset.q).toRotationMatrix();
  }
  static void place(const MovingBox& box, double t, Mat3& axes, Vec3& arm) {
    const Motion& m = box.motion;
    axes = rotation(box, t) * box.half_extents.asDiagonal();
    arm = integrate_rotation(m.start.q, m.omega, t) * m.offset.x;
  }
  static void set_axis(BoxMoment& m, int k, const Vec3& w, double sine) {
    const double along = w.dot(m.between);
    m.axis[size_t(k)] = along < 0 ? Vec3(-w) : w;
    m.sine[size_t(k)] = sine;
    m.gap[size_t(k)] = sine > parallel_box_sine ? std::fabs(along) - extent(w, m)
                                                : -std::numeric_limits<double>::infinity();
  }
  static double extent(const Vec3& w, const BoxMoment& m) {
    return (m.a.transpose() * w).cwiseAbs().sum() + (m.b.transpose() * w).cwiseAbs().sum();
  }
  static double gap_along(const Vec3& w, const BoxMoment& m) {
    return w.dot(m.between) - extent(w, m);
  }
  /// Middle Bernstein coefficient of the gap between the chords, the least of all pairs of corners.
  static double middle_gap(const BoxMoment& p, const Vec3& wp, const BoxMoment& q, const Vec3& wq) {
    return 0.5 * (wp.dot(q.between) + wq.dot(p.between) -
                  (q.a.transpose() * wp + p.a.transpose() * wq).cwiseAbs().sum() -
                  (q.b.transpose() * wp + p.b.transpose() * wq).cwiseAbs().sum());
  }

  bool free_between(const BoxMoment& p, const BoxMoment& q) const {
    const double h = q.t - p.t;
    const double arc = 0.125 * (1 + 0x1p-40) * h * h *
                       (spin_a_ * spin_a_ * lever_a_ + spin_b_ * spin_b_ * lever_b_);
    const double needed = rounding_ + arc;
    if (!(p.gap[size_t(p.best)] > rounding_) || !(q.gap[size_t(q.best)] > rounding_)) return false;
    const auto turning = [&](const Vec3& wp, const Vec3& wq) {
      return gap_along(wp, p) > needed && gap_along(wq, q) > needed &&
             middle_gap(p, wp, q, wq) > needed;
    };
    const auto at = [](const BoxMoment& m, int k) -> const Vec3& { return m.axis[size_t(k)]; };
    if (turning(at(p, p.best), at(q, q.best))) return true;
    if (p.best != q.best) {
      if (turning(at(p, p.best), at(q, p.best)) || turning(at(p, q.best), at(q, q.best)))
        return true;
    }
    if (turning(at(p, p.best), at(p, p.best)) || turning(at(q, q.best), at(q, q.best))) return true;
    const Vec3 sum = at(p, p.best) + at(q, q.best);
    const double length = sum.norm();
    return length > 1e-3 && turning(sum / length, sum / length);
  }

  double sure_step(const BoxMoment& m) const {
    const Vec3& w = m.axis[size_t(m.best)];
    const double room = m.gap[size_t(m.best)] - rounding_;
    const double rate = -w.dot(velocity_) + w.cross(a_.motion.omega).norm() * lever_a_ +
                        w.cross(b_.motion.omega).norm() * lever_b_;
    if (!(room > 0)) return 0;
    return rate * duration_ > room ? room / rate : duration_;
  }

  /// A time a little before the nearest corners along the best axis would meet.
  double towards_contact(const BoxMoment& m) const {
    const Vec3& w = m.axis[size_t(m.best)];
    const auto corner = [](const Mat3& axes, const Vec3& along) {
      Vec3 out = Vec3::Zero();
      for (int i = 0; i < 3; ++i) out += (axes.col(i).dot(along) > 0 ? 1.0 : -1.0) * axes.col(i);
      return out;
    };
    const Vec3 on_a = m.arm_a + corner(m.a, w), on_b = m.arm_b + corner(m.b, -w);
    const double rate =
        -w.dot(velocity_ + b_.motion.omega.cross(on_b) - a_.motion.omega.cross(on_a));
    const double room = m.gap[size_t(m.best)] - rounding_;
    if (!(rate > 0) || room > 2 * rate * duration_) return duration_;
    const double step = room / rate;
    return step * (1 - std::clamp(2 * step / duration_, 1e-4, 0.05));
  }

  /// Whether they overlap along every axis by more than the rounding of its direction.
  bool surely_overlap(const BoxMoment& m) const {
    for (size_t k = 0; k < box_axes; ++k) {
      if (m.sine[k] <= parallel_box_sine) continue;
      const double tilt = k < 6 ? 1e-12 * size_ : 16 * box_half_ulp * size_ / m.sine[k];
      if (!(m.gap[k] < -2 * rounding_ - tilt)) return false;
    }
    return true;
  }

  MovingBoxContact in_doubt(const BoxMoment& m) const {
    if (surely_overlap(m)) return contact_between(m, m.t, true);
    for (double step = 0x1p-42 * duration_;; step *= 4) {
      const double t = std::min(duration_, m.t + step);
      const BoxMoment later = moment(t);
      if (surely_overlap(later)) return contact_between(m, t, true);
      if (later.gap[size_t(later.best)] > 4 * rounding_ || !(t < duration_)) {
        return contact_between(m, t, false);
      }
    }
  }

  MovingBoxContact contact_between(const BoxMoment& m, double end, bool certain) const {
    const double t0 = a_.motion.t0, t1 = a_.motion.t1;
    MovingBoxContact out;
    out.t_lo = m.t > 0 ? std::max(t0, std::nextafter(t0 + m.t, t0)) : t0;
    out.t_hi = end > 0 ? std::min(t1, std::nextafter(t0 + end, t1)) : t0;
    out.certain = certain;
    out.normal = m.axis[size_t(m.best)];
    out.axis = m.best;
    return out;
  }

  const MovingBox &a_, &b_;
  double duration_;
  Vec3 apart_, velocity_;  ///< of the carriers, B relative to A
  double lever_a_, lever_b_, spin_a_, spin_b_, size_, rounding_;
};

bool sound_box(const MovingBox& box) {
  const Motion& m = box.motion;
  return box.half_extents.allFinite() && m.start.x.allFinite() && m.start.q.coeffs().allFinite() &&
         m.velocity.allFinite() && m.omega.allFinite() && m.offset.x.allFinite() &&
         m.offset.q.coeffs().allFinite() && std::isfinite(m.t0) && std::isfinite(m.t1);
}

}  // namespace

Result<std::optional<MovingBoxContact>> moving_boxes_contact(const MovingBox& a,
                                                             const MovingBox& b) {
  const auto refuse = [](ErrorCode code, const char* why) {
    return Error{code, std::string("moving_boxes_contact: ") + why, "", ""};
  };
  if (!sound_box(a) || !sound_box(b))
    return refuse(ErrorCode::numeric, "a value is not a finite number");
  for (const Quat* q :
       {&a.motion.start.q, &a.motion.offset.q, &b.motion.start.q, &b.motion.offset.q}) {
    if (!(std::fabs(q->squaredNorm() - 1) < 1e-9)) {
      return refuse(ErrorCode::invalid_argument, "a quaternion is not of unit length");
    }
  }
  if (a.half_extents.minCoeff() < 0 || b.half_extents.minCoeff() < 0) {
    return refuse(ErrorCode::invalid_argument, "half extents must be >= 0 m");
  }
  if (a.motion.t0 != b.motion.t0 || a.motion.t1 != b.motion.t1 || !(a.motion.t0 <= a.motion.t1)) {
    return refuse(ErrorCode::invalid_argument, "both motions must span the same interval");
  }
  return BoxMarch(a, b).run();
}

}  // namespace tumble
