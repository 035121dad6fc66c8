#include "engine/dynamics/event/impulses/energetic_impact.hpp"

#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

using Slip = Vec2;

/// Progress of the process: the impulse so far, and the work of its normal part.
struct ImpactWay {
  Vec3 p = Vec3::Zero();
  double work = 0;

  ImpactWay plus(double h, const ImpactWay& d) const { return {p + h * d.p, work + h * d.work}; }
};

/// Unit direction at parameter t in [0, 4), which runs around a square about the origin: no angles
/// needed.
Slip direction_around(double t) {
  const double side = std::floor(t), f = 2 * (t - side) - 1;
  Slip s;
  switch (int(side) % 4) {
    case 0:
      s = {1, f};
      break;
    case 1:
      s = {-f, 1};
      break;
    case 2:
      s = {-1, -f};
      break;
    default:
      s = {f, -1};
      break;
  }
  return s / s.norm();
}

class RouthProcess {
 public:
  explicit RouthProcess(const PointImpact& impact)
      : K_(impact.mobility),
        u0_(impact.velocity),
        mu_(impact.friction),
        kept_(impact.restitution * impact.restitution),
        scale_(impact.velocity.norm()) {
    step_ = tolerances::first_piece / ((1 + mu_) * K_.cwiseAbs().maxCoeff());
  }

  PointImpactResult run() {
    bool slides = mu_ > 0 && slip_of(now_).norm() > tolerances::no_slip_of_first * scale_;
    if (!slides) choose_way_on();
    for (out_.steps = 0; !done_ && out_.steps < tolerances::most_impact_pieces; ++out_.steps) {
      if (!slides) {
        if (go_straight(way_on_, endless)) break;
      } else if (slide()) {
        slides = false;
        choose_way_on();
        out_.reversed = !out_.stuck;
      }
    }
    charge_work(size_t(out_.steps), 300);
    if (!done_) out_.status = PointImpactStatus::invalid;
    out_.impulse = now_.p;
    out_.velocity = velocity(now_);
    out_.compression_work = lowest_;
    // The work of an impulse is p.(u_before + u_after)/2, however it grew.
    out_.friction_work = now_.p.dot(u0_) + 0.5 * now_.p.dot(K_ * now_.p) - now_.work;
    return out_;
  }

 private:
  Vec3 velocity(const ImpactWay& w) const { return u0_ + K_ * w.p; }
  Slip slip_of(const ImpactWay& w) const { return velocity(w).tail<2>(); }
  Vec3 sliding_impulse(const Slip& s) const { return {1, -mu_ * s.x(), -mu_ * s.y()}; }
  double target() const { return lowest_ * (1 - kept_); }

  /// Friction can start a new compression during expansion.
  void notice_recompression() {
    if (!compressing_ && velocity(now_).x() < -tolerances::recompression_rounding * scale_)
      compressing_ = true;
  }

  /// Lets the impulse grow along `direction` (per unit of normal impulse) up to the next change of
  /// phase, but at most to a normal impulse of `most`. True if `most` was reached before that, or
  /// if there is neither (which a positive semi-definite mobility excludes).
  bool go_straight(const Vec3& direction, double most) {
    notice_recompression();
    const double u = velocity(now_).x(), a = K_.row(0).dot(direction);
    double to_event = endless;
    if (compressing_) {
      if (a > 0) to_event = std::max(0.0, -u / a);
    } else {
      const double missing = std::max(0.0, target() - now_.work), root = u * u + 2 * a * missing;
      if (root > 0 && u + std::sqrt(root) > 0) to_event = 2 * missing / (u + std::sqrt(root));
    }
    const double length = std::min(most, to_event);
    if (!(length < endless)) return true;
    now_.p += length * direction;
    now_.work += length * (u + 0.5 * a * length);
    if (to_event <= length) take_turn();
    return !done_ && most <= length;
  }

  /// Ends the phase: greatest compression is reached, or the collision is over.
  void take_turn() {
    done_ = !compressing_;
    if (done_) return;
    compressing_ = false;
    lowest_ = std::min(lowest_, now_.work);
    done_ = !(now_.work < target());
  }

  /// Chooses how to continue without slip: it stays zero, or grows along one direction.
  void choose_way_on() {
    way_on_ = Vec3::UnitX();
    out_.stuck = true;
    if (mu_ == 0) return;
    const double a = K_(1, 1), b = K_(1, 2), c = K_(2, 2), det = a * c - b * b;
    if (!(det > tolerances::singular_mobility * std::max(a, c) * std::max(a, c))) return;
    const auto solve = [&](double x, double y) {
      return Slip((c * x - b * y) / det, (a * y - b * x) / det);
    };
    const Slip left = slip_of(now_), hold = solve(-K_(1, 0), -K_(2, 0));
    // impulse that removes the rest of slip that rounding left
    const Slip too_much = solve(left.x(), left.y());
    now_.p -= Vec3(0, too_much.x(), too_much.y());
    out_.stuck = hold.norm() <= mu_;
    way_on_ = out_.stuck ? Vec3(1, hold.x(), hold.y()) : sliding_impulse(growing_ray());
  }

  Slip slip_rate(const Slip& s) const { return (K_ * sliding_impulse(s)).tail<2>(); }

  /// The unit direction of slip whose rate of change is parallel to itself and grows fastest.
  Slip growing_ray() const {
    constexpr int parts = tolerances::slip_directions;
    const auto turning = [&](double t) {
      const Slip s = direction_around(t), r = slip_rate(s);
      return s.x() * r.y() - s.y() * r.x();
    };
    Slip best(1, 0);
    double best_growth = -endless;
    for (int k = 0; k < parts; ++k) {
      double lo = 4.0 * k / parts, hi = 4.0 * (k + 1) / parts;
      const bool rises = turning(lo) < 0;
      if (rises == (turning(hi) < 0)) continue;
      for (int i = 0; i < tolerances::direction_halvings; ++i) {
        const double mid = 0.5 * (lo + hi);
        ((turning(mid) < 0) == rises ? lo : hi) = mid;
      }
      const Slip s = direction_around(lo);
      const double growth = s.dot(slip_rate(s));
      if (growth > best_growth) best_growth = growth, best = s;
    }
    return best;
  }

  /// Continues with slip; true when slip has ended.
  bool slide() {
    const Slip slip = slip_of(now_);
    const double speed = slip.norm();
    const Slip s = slip / speed, rate = slip_rate(s);
    const double along = s.dot(rate), across = s.x() * rate.y() - s.y() * rate.x();
    if (std::fabs(across) <= tolerances::straight_slip * (K_ * sliding_impulse(s)).norm())
      return go_straight(sliding_impulse(s), along < 0 ? speed / -along : endless);
    curve();
    // Rounding can keep slip alive: the longer the process takes, the larger a slip counts as none.
    return !done_ &&
           slip_of(now_).norm() <= tolerances::no_slip_of_first * scale_ *
                                       (1 + tolerances::more_with_each_piece * out_.steps);
  }

  /// Negative before the next change of phase, zero at it.
  double event(const ImpactWay& w) const {
    return compressing_ ? velocity(w).x() : w.work - target();
  }

  /// A step of Routh's equations where slip changes its direction. The independent variable is the
  /// normal impulse divided by the slip speed, in which the equations are smooth up to the end of
  /// slip: dp = (|s|, -mu s).
  void curve() {
    notice_recompression();
    ImpactWay next;
    double error = extrapolate(step_, next);
    for (; error > tolerances::piece_error; error = extrapolate(step_, next))
      step_ *= tolerances::shorter_piece;
    if (event(next) < 0) {
      now_ = next;
      if (error < tolerances::accurate_piece * tolerances::piece_error)
        step_ *= tolerances::longer_piece;
      return;
    }
    // Regula falsi with the Illinois modification for the change of phase inside the step.
    double lo = 0, hi = step_, f_lo = event(now_), f_hi = event(next);
    for (int i = 0; i < tolerances::most_piece_root_steps &&
                    hi - lo > tolerances::piece_root * step_ && f_hi != 0;
         ++i) {
      double mid = lo - f_lo * (hi - lo) / (f_hi - f_lo);
      if (!(mid > lo && mid < hi)) mid = 0.5 * (lo + hi);
      ImpactWay there;
      extrapolate(mid, there);
      const double f = event(there);
      if (f >= 0) {
        hi = mid, f_hi = f, f_lo *= 0.5, next = there;
      } else {
        lo = mid, f_lo = f, f_hi *= 0.5;
      }
    }
    now_ = next;
    take_turn();
  }

  ImpactWay rates(const ImpactWay& w) const {
    const Vec3 u = velocity(w);
    const double speed = u.tail<2>().norm();
    return {{speed, -mu_ * u.y(), -mu_ * u.z()}, u.x() * speed};
  }
  /// Gragg's modified midpoint rule with Richardson extrapolation (Hairer, Norsett & Wanner 1993,
  /// II.9) over h, order 12. Returns the error of the velocity relative to the initial one.
  double extrapolate(double h, ImpactWay& end) const {
    constexpr size_t rows = 6;
    std::array<ImpactWay, rows> row;
    for (size_t r = 0; r < rows; ++r) {
      ImpactWay value = midpoint_rule(h, 2 * int(r + 1));
      for (size_t c = 0; c <= r; ++c) {
        const ImpactWay old = row[c];
        row[c] = value;
        if (c == r) break;
        const double ratio = double(r + 1) / double(r - c), f = 1 / (ratio * ratio - 1);
        value = {value.p + f * (value.p - old.p), value.work + f * (value.work - old.work)};
      }
    }
    end = row[rows - 1];
    return (K_ * (end.p - row[rows - 2].p)).norm() / scale_;
  }
  ImpactWay midpoint_rule(double h, int n) const {
    const double part = h / n;
    ImpactWay last = now_, here = now_.plus(part, rates(now_));
    for (int k = 1; k < n; ++k) {
      const ImpactWay on = last.plus(2 * part, rates(here));
      last = here;
      here = on;
    }
    const ImpactWay end = rates(here);
    return {0.5 * (last.p + here.p + part * end.p),
            0.5 * (last.work + here.work + part * end.work)};
  }

  Mat3 K_;
  Vec3 u0_;
  double mu_, kept_, scale_, step_;
  ImpactWay now_;
  bool compressing_ = true, done_ = false;
  double lowest_ = 0;  ///< work at the greatest compression
  Vec3 way_on_ = Vec3::UnitX();
  PointImpactResult out_;
};

}  // namespace

PointImpactResult energetic_impact(const PointImpact& impact) {
  PointImpactResult out;
  out.velocity = impact.velocity;
  const bool sound = impact.mobility.allFinite() && impact.velocity.allFinite() &&
                     impact.mobility(0, 0) > 0 && impact.friction >= 0 &&
                     std::isfinite(impact.friction) && impact.restitution >= 0 &&
                     impact.restitution <= 1;
  if (!sound) {
    out.status = PointImpactStatus::invalid;
  } else if (!(impact.velocity.x() < 0)) {
    out.status = PointImpactStatus::separating;
  } else {
    out = RouthProcess(impact).run();
  }
  return out;
}

}  // namespace tumble
