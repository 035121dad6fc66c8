// A machine that walks and one that rides by themselves, under the event stepper. References: the
// gaits of the simplest walking model and their eigenvalues (Garcia, Chatterjee, Ruina and Coleman
// 1998), the linearised equations and critical speeds of the bicycle (Meijaard, Papadopoulos, Ruina
// and Schwab 2007).
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/scale.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include <Eigen/LU>

using namespace tumble;
using namespace tumble::test;

namespace {

using State2 = Eigen::Vector2d;
using State4 = Eigen::Vector4d;
using Mat2 = Eigen::Matrix2d;

/// A hip of mass 1 on two legs of length 1 whose mass is next to nothing, on a slope; the foot that
/// stands is a hinge in the world. A leg has its mass in halves at foot and hip, so that it swings
/// as a point mass at the foot does. z is across, y across the slope, x down it; gravity is 1.
struct Walker : EventWorld {
  static constexpr double slope = 0.009, leg_mass = 1e-8;
  uint32_t standing = 1, swinging = 2;

  Walker() : EventWorld(25) {
    gravity = Vec3(std::sin(slope), -std::cos(slope), 0);
    add(lump(1, 1));
    add(lump(leg_mass, leg_mass / 4));
    add(lump(leg_mass, leg_mass / 4));
  }
  static BodyDef lump(double mass, double inertia) {
    BodyDef d;
    d.mass = mass;
    d.inertia = Vec3::Constant(inertia);
    return d;
  }
  /// The place of a leg's foot in its frame, whose y axis points from foot to hip.
  static Vec3 foot() { return {0, -0.5, 0}; }
  static Quat leaning(double angle) { return axis_angle(Vec3::UnitZ(), angle); }
  double angle(uint32_t leg) const {
    const Vec3 up = bodies[leg].pose.q * Vec3::UnitY();
    return std::atan2(-up.x(), up.y());
  }
  /// Of the leg that swings, from the one that stands: in the paper's signs.
  double open() const { return angle(standing) - angle(swinging); }

  /// Right after a step, both feet on the ground, with the angle and rate of the leg that stands.
  void begin(const State2& state) {
    const double theta = state[0], rate = state[1];
    const double swing = -theta, swing_rate = rate - (1 - std::cos(2 * theta)) * rate;
    const Vec3 hip(-std::sin(theta), std::cos(theta), 0);
    const Vec3 speed = rate * Vec3(-std::cos(theta), -std::sin(theta), 0);
    put(0, hip, 0, speed, 0);
    put(standing, 0.5 * hip, theta, 0.5 * speed, rate);
    const Quat q = leaning(swing);
    const Vec3 arm = q * foot();
    put(swinging, hip + arm, swing, speed + swing_rate * Vec3::UnitZ().cross(arm), swing_rate);
    stand_on(Vec3::Zero());
  }
  void put(uint32_t i, const Vec3& x, double turn, const Vec3& v, double rate) {
    bodies[i].pose = {x, leaning(turn)};
    bodies[i].v = v;
    bodies[i].omega = {0, 0, rate};
  }
  void stand_on(const Vec3& at) {
    joints.clear();
    join(JointKind::revolute, no_body, standing, {at, Quat::Identity()});
    const Vec3 hip = bodies[0].pose.x;
    join(JointKind::revolute, 0, standing, {hip, Quat::Identity()});
    join(JointKind::revolute, 0, swinging, {hip, Quat::Identity()});
  }
  /// One step: until the foot that swings is at the ground in front, where it is caught by a hinge
  /// in place of the other one: the joints' impulses are those of a foot that stays. What is left.
  State2 step_over(const State2& state) {
    begin(state);
    const double tick = h;
    const auto above = [this] { return 2 * angle(standing) - open(); };
    double was = above();
    for (int k = 0;; ++k) {
      REQUIRE(k < 100000);  // else it has fallen
      const std::vector<RigidBody> before = bodies;
      step();
      // From above: where legs pass each other, feet of equal legs scuff, which the model leaves
      // out.
      if (angle(standing) < 0 && was > 0 && above() <= 0) {
        double low = 0, high = tick;
        for (int i = 0; i < 36; ++i) {
          h = 0.5 * (low + high);
          bodies = before;
          step();
          (above() <= 0 ? high : low) = h;
        }
        break;
      }
      was = above();
    }
    h = tick;
    std::swap(standing, swinging);
    stand_on(bodies[standing].pose.x + bodies[standing].pose.q * foot());
    catch_foot();
    return {angle(standing), bodies[standing].omega.z()};
  }
  void catch_foot() {
    std::vector<uint32_t> slots(3), which(3);
    std::iota(slots.begin(), slots.end(), 0u);
    std::iota(which.begin(), which.end(), 0u);
    std::vector<DofBlock> blocks = blocks_of(bodies, slots);
    Articulation held({joints}, {which}, slots, bodies, 3);
    held.update(bodies, blocks);
    std::vector<double> impulses(held.size());
    held.hold_velocities(blocks, impulses);
    for (uint32_t i = 0; i < 3; ++i) {
      bodies[i].v = blocks[i].v;
      bodies[i].omega = blocks[i].omega;
    }
  }
};

/// The derivative of a step by the state that it begins with.
template <class Step>
Mat2 derivative(const Step& step, const State2& at) {
  Mat2 out;
  for (int i = 0; i < 2; ++i) {
    const State2 aside = 1e-5 * State2::Unit(i);
    out.col(i) = (step(at + aside) - step(at - aside)) / 2e-5;
  }
  return out;
}

/// A step by the paper's equations for the angle of the leg that stands and that between the legs.
State2 published_step(const State2& state) {
  const auto change = [](const State4& y) {
    const double falls = std::sin(y[0] - Walker::slope);
    return State4(y[1], falls, y[3],
                  falls + (y[1] * y[1] - std::cos(y[0] - Walker::slope)) * std::sin(y[2]));
  };
  const auto moved = [&](const State4& y, double h) -> State4 {
    const State4 a = change(y), b = change(y + h / 2 * a), c = change(y + h / 2 * b),
                 d = change(y + h * c);
    return y + h / 6 * (a + 2 * b + 2 * c + d);
  };
  const auto above = [](const State4& y) { return 2 * y[0] - y[2]; };
  State4 y(state[0], state[1], 2 * state[0], (1 - std::cos(2 * state[0])) * state[1]);
  double h = 0.005;
  for (State4 next = moved(y, h); !(next[0] < 0 && above(y) > 0 && above(next) <= 0);
       next = moved(y, h))
    y = next;
  double low = 0;
  for (int i = 0; i < 45; ++i) (above(moved(y, 0.5 * (low + h))) <= 0 ? h : low) = 0.5 * (low + h);
  y = moved(y, h);
  return {-y[0], std::cos(2 * y[0]) * y[1]};
}

/// The bicycle of the benchmark: two knife-edge wheels, a rear frame with its rider, a fork. x is
/// ahead, y up, z to the right; the wheels are ellipsoids next to as thin as discs.
struct Bicycle : EventWorld {
  static constexpr double pi = std::numbers::pi;
  uint32_t frame = 0, fork = 0, rear = 0, front = 0;

  Bicycle(double speed, double lean_rate) : EventWorld(120) {
    floor(1);
    frame = part({0.3, 0.9, 0}, 85, {9.2, 2.8, 11}, -2.4);
    fork = part({0.9, 0.7, 0}, 4, {0.05892, 0.00708, 0.06}, 0.00756);
    rear = wheel({0, 0.3, 0}, 0.3, 2, {0.0603, 0.0603, 0.12});
    front = wheel({1.02, 0.35, 0}, 0.35, 3, {0.1405, 0.1405, 0.28});
    for (const uint32_t i : {frame, fork, rear, front}) {
      RigidBody& b = bodies[i];
      b.omega = {lean_rate, 0, 0};
      b.v = Vec3(speed, 0, 0) + b.omega.cross(b.pose.x);
    }
    bodies[rear].omega.z() = -speed / 0.3;
    bodies[front].omega.z() = -speed / 0.35;
    join(JointKind::revolute, frame, rear, {{0, 0.3, 0}, Quat::Identity()});
    join(JointKind::revolute, fork, front, {{1.02, 0.35, 0}, Quat::Identity()});
    join(JointKind::revolute, frame, fork,
         {{1.1, 0, 0}, rotation_between(Vec3::UnitZ(), steering_axis())});
  }
  uint32_t part(const Vec3& x, double mass, const Vec3& inertia, double xy) {
    BodyDef d;
    d.pose.x = x;
    d.mass = mass;
    d.inertia = inertia;
    d.products = Vec3(xy, 0, 0);
    return add(d);
  }
  uint32_t wheel(const Vec3& x, double radius, double mass, const Vec3& inertia) {
    BodyDef d = body(ellipsoid({radius, radius, 0.003}), x, 1);
    d.mass = mass;
    d.inertia = inertia;
    return add(d);
  }
  /// Lean to the right, steering to the left about the axis that points up, and their rates.
  State4 state() const {
    const RigidBody &a = bodies[frame], &b = bodies[fork];
    const Vec3 across = a.pose.q * Vec3::UnitZ(), axis = a.pose.q * steering_axis();
    const Vec3 fork_across = b.pose.q * Vec3::UnitZ();
    const Vec3 ahead = Vec3(0, 1, 0).cross(across).normalized();
    return {-std::asin(across.y()), std::asin(across.cross(fork_across).dot(axis)),
            a.omega.dot(ahead), (b.omega - a.omega).dot(axis)};
  }
  static Vec3 steering_axis() { return {-std::sin(pi / 10), std::cos(pi / 10), 0}; }
};

/// How a bicycle moves that runs straight ahead and is given a little lean: the matrix by which its
/// state grows in a second, fitted to what it does.
std::vector<std::complex<double>> modes_of_ride(double speed) {
  Bicycle w(speed, 1e-3);
  constexpr int samples = 22, every = 6;
  Eigen::MatrixXd now(4, samples), next(4, samples);
  for (int i = 0; i < samples; ++i) {
    now.col(i) = w.state();
    for (int k = 0; k < every; ++k) w.step();
    next.col(i) = w.state();
  }
  const Eigen::MatrixXd growth = least_norm(now.transpose(), next.transpose(), 1e-12).x.transpose();
  std::vector<std::complex<double>> out = eigenvalues(growth);
  for (auto& e : out) e = std::log(e) / (every * w.h);
  return out;
}

/// The same of the paper's equations: M q'' + v C q' + (g K0 + v^2 K2) q = 0 for lean and steer.
std::vector<std::complex<double>> published_modes(double v) {
  Mat2 M, C, K0, K2;
  M << 80.81722, 2.31941332208709, 2.31941332208709, 0.29784188199686;
  C << 0, 33.86641391492494, -0.85035641456978, 1.68540397397560;
  K0 << -80.95, -2.59951685249872, -2.59951685249872, -0.80329488458618;
  K2 << 0, 76.59734589573222, 0, 2.65431523794604;
  Eigen::Matrix4d all = Eigen::Matrix4d::Zero();
  all.topRightCorner<2, 2>().setIdentity();
  all.bottomLeftCorner<2, 2>() = -M.inverse() * (9.81 * K0 + v * v * K2);
  all.bottomRightCorner<2, 2>() = -M.inverse() * (v * C);
  return eigenvalues(all);
}

}  // namespace

TEST_CASE("the simplest walker has the two gaits of its paper, and their eigenvalues") {
  Walker w;
  const auto step = [&w](const State2& state) { return w.step_over(state); };
  for (const State2& gait :
       {State2(.20031090049483, -.19983247291764), State2(.19393736960624, -.20386692731962)}) {
    if (only_to_run()) {
      w.begin(gait);
      w.run(0.2);
      continue;
    }
    State2 at = gait + State2(1e-4, -1e-4);
    const Mat2 slope = derivative(step, at) - Mat2::Identity();
    for (int i = 0; i < 4; ++i) at -= slope.inverse() * (step(at) - at);
    CHECK((at - gait).cwiseAbs().maxCoeff() < 1e-6);
    const auto seen = eigenvalues(derivative(step, at));
    const auto wanted = eigenvalues(derivative(published_step, gait));
    for (size_t i = 0; i < 2; ++i) CHECK(std::abs(seen[i] - wanted[i]) < 1e-4);
  }
  // The equations as integrated here, against an adaptive integration in other software (SciPy).
  // Tables that go round have -.191209 +- .556334i for the long gait, .0017 away from both.
  const auto ours = eigenvalues(derivative(published_step, {.20031090049483, -.19983247291764}));
  CHECK(std::abs(ours[0] - std::complex(-0.190100, 0.557599)) < 2e-6);
}

TEST_CASE("a bicycle rides by itself between its weave and capsize speeds, and not beyond") {
  constexpr double weave = 4.29238253634111, capsize = 6.02426201538837;
  // The equations are those of these two speeds.
  CHECK(std::fabs(published_modes(weave)[0].real()) < 1e-9);
  CHECK(std::fabs(published_modes(capsize)[0].real()) < 1e-9);
  if (only_to_run()) {
    Bicycle(5, 1e-3).run(0.05);
    return;
  }
  const auto stable = [](double speed) { return modes_of_ride(speed)[0].real() < 0; };
  CHECK(!stable(0.99 * weave));
  CHECK(stable(1.01 * weave));
  CHECK(stable(0.99 * capsize));
  CHECK(!stable(1.01 * capsize));
  const auto seen = modes_of_ride(5), wanted = published_modes(5);
  for (size_t i = 0; i < 4; ++i) {
    CHECK(std::abs(seen[i] - wanted[i]) < 0.01 * std::abs(wanted[i]));
  }
}
