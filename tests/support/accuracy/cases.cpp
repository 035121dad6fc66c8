#include "tests/support/accuracy/cases.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tumble::test {
namespace {

constexpr double g = 9.81;
constexpr double pi = 3.14159265358979323846;

int count_of(int hz, double seconds) {
  return int(hz * seconds + 0.5);
}

/// The generator of the published workloads: Knuth's MMIX, its upper 31 bits.
struct CaseDraw {
  uint64_t s;
  double uniform(double a, double b) {
    s = s * 6364136223846793005ULL + 1442695040888963407ULL;
    return a + (b - a) * (double(s >> 33) / 2147483648.0);
  }
};

/// How often the sign of the turn about the middle axis changes: Euler's equations by RK4 with
/// steps of 1e-4 s.
int flips_of_reference(const Vec3& inertia, Vec3 w, double seconds) {
  const auto rate = [&](const Vec3& u) {
    return Vec3((inertia.y() - inertia.z()) * u.y() * u.z() / inertia.x(),
                (inertia.z() - inertia.x()) * u.z() * u.x() / inertia.y(),
                (inertia.x() - inertia.y()) * u.x() * u.y() / inertia.z());
  };
  const double h = 1e-4;
  int flips = 0;
  double sign = 1;
  for (int i = 0; i < int(seconds / h + 0.5); ++i) {
    const Vec3 k1 = rate(w), k2 = rate(w + 0.5 * h * k1), k3 = rate(w + 0.5 * h * k2),
               k4 = rate(w + h * k3);
    w += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (std::fabs(w.y()) > 1 && w.y() * sign < 0) ++flips, sign = -sign;
  }
  return flips;
}

}  // namespace

CaseScene rolling_scene() {
  CaseScene s;
  s.bodies.push_back(case_floor(0.2));
  s.bodies.back().friction_largest = 0.4;
  s.bodies.push_back(case_box({0, 0.5, 0}, {10, 0.5, 10}, 10, 0.8));
  s.bodies.back().friction_largest = 0.4;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      s.bodies.push_back(case_ball({i * 2 - 4.0, 1.5, j * 2 - 4.0}, 0.5, 1, 0.8, 0));
  return s;
}

RollingErrors a1_rolling(const CaseMaker& maker, int hz, const Vec3& direction, double seconds) {
  CaseRun run(rolling_scene(), maker, hz);
  run.world().set_force(1, 150 * direction);
  for (int i = 0; i < count_of(hz, seconds); ++i) run.step();
  const double slab = (150 - 0.4 * 35 * g) / (10 + 25 * 2.0 / 7) * seconds, ball = 2.0 / 7 * slab;
  return {(run[1].v - slab * direction).norm() / slab, (run[14].v - ball * direction).norm() / ball,
          run[1].v.dot(direction) / slab};
}

BounceErrors a2_bounces(const CaseMaker& maker, int hz, double seconds) {
  CaseScene s;
  s.elastic = true;
  s.bodies.push_back(case_floor(0, 1));
  s.bodies.push_back(case_ball({0, 5, 0}, 0.1, 10, 0, 1));
  CaseRun run(s, maker, hz);
  BounceErrors out;
  const double fall = std::sqrt(2 * 4.9 / g);
  for (int i = 1; i <= count_of(hz, seconds); ++i) {
    run.step();
    const double t = std::remainder(double(i) / hz, 2 * fall);  // since it was highest
    out.place = std::max(out.place, std::fabs(run[1].pose.x.y() - 5 + 0.5 * g * t * t));
    const double higher = run.energy() / (10 * g) - 5;
    out.height = std::max(out.height, std::fabs(higher));
    out.energy_end = higher / 4.9;
  }
  out.energy_most = out.height / 4.9;
  return out;
}

std::vector<CaseBody> block_of_balls(double lowest, double restitution, uint64_t start) {
  CaseDraw draw{start};
  std::vector<CaseBody> out;
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double x = (i - 2.5) * 0.21 + draw.uniform(-0.001, 0.001);
        const double z = (j - 2.5) * 0.21 + draw.uniform(-0.001, 0.001);
        out.push_back(case_ball({x, lowest + k * 0.21, z}, 0.1, 10, 0, restitution));
      }
  return out;
}

CaseScene gas_scene(bool gravity) {
  CaseScene s;
  s.elastic = true;
  s.bodies = block_of_balls(1.101, 1);
  if (gravity) {
    s.bodies.insert(s.bodies.begin(), case_floor(0, 1));
    return s;
  }
  s.gravity.setZero();
  for (size_t i = 0; i < s.bodies.size(); ++i) {
    const bool low = i < s.bodies.size() / 2;
    s.bodies[i].pose.x.y() += low ? 0 : 0.3;
    s.bodies[i].v.y() = low ? 1 : -0.5;
  }
  return s;
}

GasErrors a3_gas(const CaseMaker& maker, int hz, bool gravity, double seconds) {
  CaseRun run(gas_scene(gravity), maker, hz);
  const double lowest = gravity ? 216 * 10 * g * 0.1 : 0;  // all on the floor
  const double start = run.energy() - lowest;
  const Vec3 momentum = run.momentum();
  GasErrors out;
  for (int i = 0; i < count_of(hz, seconds); ++i) {
    run.step();
    out.energy_end = (run.energy() - lowest) / start - 1;
    out.energy_most = std::max(out.energy_most, std::fabs(out.energy_end));
    if (!gravity) out.momentum = std::max(out.momentum, (run.momentum() - momentum).norm() / 1080);
  }
  return out;
}

CradleErrors a4_cradle(const CaseMaker& maker, int hz, double gap) {
  CaseScene s;
  s.elastic = true;
  s.gravity.setZero();
  for (int i = 0; i < 5; ++i)
    s.bodies.push_back(case_ball({i ? i * (1 + gap) : -1.0, 0, 0}, 0.5, 1, 0, 1));
  s.bodies[0].v.x() = 1;
  CaseRun run(s, maker, hz);
  for (int i = 0; i < count_of(hz, 3); ++i) run.step();
  CradleErrors out;
  double squares = 0;
  for (size_t i = 0; i < 5; ++i) {
    out.v[i] = run[i].v.x();
    squares += (run[i].v - Vec3(i == 4, 0, 0)).squaredNorm();
  }
  out.velocity = std::sqrt(squares);
  out.energy = run.energy() / 0.5 - 1;
  return out;
}

PendulumErrors a5_double_pendulum(const CaseMaker& maker, int hz, double seconds) {
  CaseScene s;
  s.collide = false;
  for (int i = 0; i < 2; ++i)
    s.bodies.push_back(case_box({0.5 + i, 0, 0}, {0.5, 0.05, 0.05}, 1, 0));
  s.joints = {{-1, 0, {0, 0, 0}}, {0, 1, {1, 0, 0}}};
  CaseRun run(s, maker, hz);
  const double start = run.energy();
  PendulumErrors out;
  for (int i = 1; i <= count_of(hz, seconds); ++i) {
    run.step();
    out.energy_end = (run.energy() - start) / (2 * g);
    out.energy_most = std::max(out.energy_most, std::fabs(out.energy_end));
    if (i == 10 * hz) out.energy_10s = out.energy_end;
    const Vec3 end = run[0].pose.point({0.5, 0, 0});
    out.joint = std::max({out.joint, run[0].pose.point({-0.5, 0, 0}).norm(),
                          (run[1].pose.point({-0.5, 0, 0}) - end).norm()});
  }
  return out;
}

HandleErrors a6_handle(const CaseMaker& maker, int hz, double seconds) {
  CaseScene s;
  s.collide = false;
  s.gravity.setZero();
  CaseBody handle = case_ball({0, 0, 0}, 0.1, 1, 0, 0);
  handle.inertia = {0.5, 1, 1.3};
  handle.omega = {0.01, 5, 0.01};
  s.bodies.push_back(handle);
  CaseRun run(s, maker, hz);
  const Vec3 momentum = run.angular_momentum(0);
  const double start = run.kinetic();
  HandleErrors out;
  double sign = 1;
  for (int i = 0; i < count_of(hz, seconds); ++i) {
    run.step();
    out.momentum_end = (run.angular_momentum(0) - momentum).norm() / momentum.norm();
    out.momentum_most = std::max(out.momentum_most, out.momentum_end);
    out.energy_end = run.kinetic() / start - 1;
    out.energy_most = std::max(out.energy_most, std::fabs(out.energy_end));
    const double turn = run[0].pose.inverse_direction(run[0].omega).y();
    if (std::fabs(turn) > 1 && turn * sign < 0) ++out.flips, sign = -sign;
  }
  out.flips_wanted = flips_of_reference(handle.inertia, handle.omega, seconds);
  return out;
}

Slide a7_slide(const CaseMaker& maker, int hz, const Vec3& direction, double slope,
               double seconds) {
  CaseScene s;
  s.bodies.push_back(case_floor(0.5));
  s.bodies.push_back(case_box({0, 0.5, 0}, {0.5, 0.5, 0.5}, 10, 0.5));
  CaseRun run(s, maker, hz);
  for (int i = 0; i < hz; ++i) run.step();
  const Vec3 start = run[1].pose.x;
  const double tilt = std::atan(slope);
  run.world().set_gravity(g * std::sin(tilt) * direction - g * std::cos(tilt) * Vec3::UnitY());
  for (int i = 0; i < count_of(hz, seconds); ++i) run.step();
  const Vec3 gone = run[1].pose.x - start;
  const double along = gone.dot(direction);
  return {along, run[1].v.dot(direction), (gone - along * direction).norm()};
}

FrictionErrors a7_friction(const CaseMaker& maker, int hz, const Vec3& direction) {
  double low = 0.3, high = 0.9;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    (a7_slide(maker, hz, direction, middle, 2).distance > 0.01 ? high : low) = middle;
  }
  const double tilt = std::atan(0.8), a = g * (std::sin(tilt) - 0.5 * std::cos(tilt));
  return {0.5 * (low + high), a7_slide(maker, hz, direction, 0.8, 2).speed / (2 * a) - 1,
          a7_slide(maker, hz, direction, 0.45, 5).distance};
}

SinkErrors a8_sink(const CaseMaker& maker, int hz, double mass) {
  CaseScene s;
  s.bodies.push_back(case_floor(0.5));
  s.bodies.push_back(case_box({0, 0.5, 0}, {0.5, 0.5, 0.5}, 1, 0.5));
  s.bodies.push_back(case_box({0, 1.5, 0}, {0.5, 0.5, 0.5}, mass, 0.5));
  CaseRun run(s, maker, hz);
  SinkErrors out;
  for (int i = 0; i < count_of(hz, 10); ++i) {
    run.step();
    out.end = 1.5 - run[2].pose.x.y();
    out.most = std::max(out.most, out.end);
  }
  out.speed = run[2].v.norm();
  return out;
}

CaseScene card_house(int storeys) {
  CaseScene s;
  s.bodies.push_back(case_floor(0.7));
  const double lean = 25 * pi / 180, half_length = 0.2, half_thickness = 0.005;
  const double cosine = std::cos(lean), sine = std::sin(lean), width = 0.36;
  const double out = half_length * sine + half_thickness * cosine;
  const double up = half_length * cosine + half_thickness * sine;
  const auto add = [&](const Vec3& x, const Vec3& half, double angle) {
    s.bodies.push_back(case_box(x, half, 8 * half.prod() * 500, 0.7));
    s.bodies.back().pose.q = Quat(std::cos(angle / 2), 0, 0, std::sin(angle / 2));
  };
  double y = 0;
  for (int storey = 0; storey < storeys; ++storey) {
    const int pairs = storeys - storey;
    const double first = -(pairs - 1) * width / 2;
    for (int i = 0; i < pairs; ++i)
      for (const int side : {-1, 1})
        add({first + i * width + side * out, y + up, 0}, {half_thickness, half_length, 0.15},
            side * lean);
    y += 2 * up;
    for (int i = 0; i + 1 < pairs; ++i)
      add({first + (i + 0.5) * width, y + half_thickness, 0},
          {width / 2 - 0.002, half_thickness, 0.15}, 0);
    y += 2 * half_thickness;
  }
  return s;
}

CardErrors a9_cards(const CaseMaker& maker, int hz, double seconds, int storeys) {
  const CaseScene s = card_house(storeys);
  CaseRun run(s, maker, hz);
  const auto moved = [&](size_t i) { return (run[i].pose.x - s.bodies[i].pose.x).norm(); };
  CardErrors out;
  out.cards = int(s.bodies.size()) - 1;
  for (int i = 1; i <= count_of(hz, seconds); ++i) {
    run.step();
    if (i != hz) continue;
    for (size_t k = 1; k < s.bodies.size(); ++k) out.moved_1s = std::max(out.moved_1s, moved(k));
  }
  for (size_t k = 1; k < s.bodies.size(); ++k) {
    out.moved_end = std::max(out.moved_end, moved(k));
    out.fallen += moved(k) > 0.05;
  }
  out.kinetic = run.kinetic();
  return out;
}

double a10_penetration(const CaseMaker& maker, int hz, double seconds, uint64_t draw) {
  CaseScene s;
  s.bodies = block_of_balls(0.101, 0, draw);
  s.bodies.push_back(case_floor(0));
  CaseRun run(s, maker, hz);
  double deepest = 0;
  for (int i = 0; i < count_of(hz, seconds); ++i) {
    run.step();
    for (size_t a = 0; a < 216; ++a) {
      deepest = std::max(deepest, 0.1 - run[a].pose.x.y());
      for (size_t b = 0; b < a; ++b)
        deepest = std::max(deepest, 0.2 - (run[a].pose.x - run[b].pose.x).norm());
    }
  }
  return deepest;
}

}  // namespace tumble::test
