// The scene rattleback. Reference: the equations of a rigid body that rolls without slip on a
// plane, integrated here on their own by the classical Runge-Kutta method with steps of 1/19200 s
// (halving them changes the spin by less than 1e-9 rad/s in six seconds).
#include "engine/math/rotation.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/shipped_scene.hpp"
#include "tests/support/dense3.hpp"

#include <algorithm>

#include <fmt/format.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// The stone of Kane & Levinson, "Realistic mathematical modeling of the rattleback", Int. J.
/// Non-Linear Mechanics 17 (1982) 175, in the axes of the ellipsoid: x lengthwise, y up.
struct Stone {
  double mass = 1, gravity = 9.81;
  Vec3 squares{0.2 * 0.2, 0.02 * 0.02, 0.03 * 0.03};  ///< of the semi-axes [m2]
  Vec3 centre{0, 0.01, 0};                            ///< of the ellipsoid, from that of mass [m]
  /// About the centre of mass [kg m2].
  Mat3 inertia{2e-4, 0, 0.2e-4, 0, 17e-4, 0, 0.2e-4, 0, 16e-4};

  /// From the centre of mass to the point of contact, where the vertical is `up`.
  Vec3 contact(const Vec3& up) const {
    const Vec3 s = squares.cwiseProduct(up);
    return centre - s / std::sqrt(up.dot(s));
  }
  /// How fast that point travels in the stone, where the vertical changes by `up_rate`.
  Vec3 contact_rate(const Vec3& up, const Vec3& up_rate) const {
    const Vec3 s = squares.cwiseProduct(up), ds = squares.cwiseProduct(up_rate);
    const double h = std::sqrt(up.dot(s));
    return -ds / h + s * (up.dot(ds) / (h * h * h));
  }
};

/// Orientation and angular velocity (of the stone, in its axes), and where the centre of mass is.
struct Rolling {
  Quat q;
  Vec3 w, x;

  Vec3 up() const { return q.conjugate() * Vec3::UnitY(); }
  double spin() const { return w.dot(up()); }
};

struct RollingRate {
  Vec4 q;
  Vec3 w, x;
};

/// With p from the centre to the contact, rolling is v = -w x p, so that a = -w' x p - w x p' with
/// p' seen from the ground; the force of the contact is m (a - g), its moment p x m (a - g), and
///   (I + m (p.p 1 - p p^T)) w' = -w x I w - m p x (w x p') + m g p x up.
RollingRate rate(const Stone& s, const Rolling& r) {
  const Vec3 up = r.up(), p = s.contact(up);
  const Vec3 p_rate = s.contact_rate(up, -r.w.cross(up)) + r.w.cross(p);
  const Mat3 about = s.inertia + s.mass * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
  const Vec3 moment = -r.w.cross(s.inertia * r.w) - s.mass * p.cross(r.w.cross(p_rate)) +
                      s.mass * s.gravity * p.cross(up);
  const Quat turn = r.q * Quat(0, r.w.x(), r.w.y(), r.w.z());
  return {0.5 * turn.coeffs(), solve(about, moment), r.q * (-r.w.cross(p))};
}

Rolling moved(Rolling r, const RollingRate& d, double h) {
  r.q.coeffs() += h * d.q;
  r.q.normalize();
  r.w += h * d.w;
  r.x += h * d.x;
  return r;
}

Rolling advanced(const Stone& s, const Rolling& r, double h) {
  const RollingRate a = rate(s, r), b = rate(s, moved(r, a, h / 2)),
                    c = rate(s, moved(r, b, h / 2)), d = rate(s, moved(r, c, h));
  return moved(r,
               {(a.q + 2 * b.q + 2 * c.q + d.q) / 6, (a.w + 2 * b.w + 2 * c.w + d.w) / 6,
                (a.x + 2 * b.x + 2 * c.x + d.x) / 6},
               h);
}

/// The reference beside a body of the scene, whose own axes are the principal ones.
struct Beside {
  Stone stone;
  Rolling rolling;
  double reversal = 0, reversal_in_scene = 0;  ///< first times without spin [s]
  double spin_error = 0, place_error = 0, tilt_error = 0;

  Beside(const RigidBody& b, const Vec3& w) {
    // The ellipsoid's axes in those of the body.
    const double skew = 0.5 * std::atan(2 * 0.2 / (16 - 2));
    rolling.q = axis_angle(Vec3::UnitY(), -skew);
    rolling.w = rolling.q.conjugate() * w;
    rolling.x = b.pose.x;
  }
  void compare(const RigidBody& b, double t, double tick) {
    const double before = rolling.spin(), before_in_scene = spin_;
    const int parts = std::max(1, int(std::lround(tick * 19200)));
    for (int k = 0; k < parts; ++k) rolling = advanced(stone, rolling, tick / parts);
    spin_ = b.omega.y();
    spin_error = std::max(spin_error, std::fabs(spin_ - rolling.spin()));
    place_error = std::max(place_error, (b.pose.x - rolling.x).norm());
    const Vec3 up = rolling.q * Vec3::UnitY();
    tilt_error = std::max(tilt_error, (b.pose.direction(Vec3::UnitY()) - up).norm());
    const auto crossing = [&](double from, double to, double& first) {
      if (first == 0 && from < 0 && to >= 0) first = t - tick * to / (to - from);
    };
    crossing(before, rolling.spin(), reversal);
    crossing(before_in_scene, spin_, reversal_in_scene);
  }

 private:
  double spin_ = 0;
};

}  // namespace

TEST_CASE("rattleback: spin, tilt, path and moment of reversal are those of rolling without slip") {
  double before = 0;
  for (const double hz : {960, 1920}) {
    CAPTURE(hz);
    BuiltScene s = shipped("rattleback", {fmt::format("settings.tick_hz={}", hz)});
    CHECK(body(s, "celt").mass == 1);
    const double energy = s.world->frame()->stats.energies.total();
    Beside celt(body(s, "celt"), {0, -5, 0.3}), twin(body(s, "twin"), {0, 5, 0.3});
    for (int k = 1; k <= 6 * hz; ++k) {
      run(s, 1 / hz);
      celt.compare(body(s, "celt"), k / hz, 1 / hz);
      twin.compare(body(s, "twin"), k / hz, 1 / hz);
    }
    const double kept = std::fabs(s.world->frame()->stats.energies.total() / energy - 1);
    MESSAGE(hz, " Hz: reverses after ", celt.reversal, " s, in the scene ", celt.reversal_in_scene,
            " s; errors of spin ", celt.spin_error, " and ", twin.spin_error, " rad/s, of tilt ",
            celt.tilt_error, ", of place ", celt.place_error, " m, of energy ", kept);
    CHECK(celt.reversal == doctest::Approx(3.24).epsilon(0.01));
    CHECK(std::fabs(celt.reversal_in_scene - celt.reversal) < 1e-4);
    CHECK(celt.spin_error < 1e-2);
    CHECK(twin.spin_error < 1e-6);
    CHECK(celt.tilt_error < 1e-3);
    CHECK(celt.place_error < 1e-5);
    CHECK(body(s, "celt").omega.y() > 3);
    CHECK(body(s, "twin").omega.y() > 4.5);
    CHECK(kept < 2e-5);
    if (before > 0) CHECK(celt.spin_error < before / 6);
    before = celt.spin_error;
  }
}
