#include "tests/support/accuracy/case_world.hpp"

namespace tumble::test {

CaseBody case_box(const Vec3& x, const Vec3& half, double mass, double friction) {
  CaseBody b;
  b.half = half;
  b.mass = mass;
  const Vec3 squares = half.cwiseAbs2();
  b.inertia = mass / 3 * (Vec3::Constant(squares.sum()) - squares);
  b.pose.x = x;
  b.friction = friction;
  return b;
}

CaseBody case_ball(const Vec3& x, double radius, double mass, double friction, double restitution) {
  CaseBody b;
  b.radius = radius;
  b.mass = mass;
  b.inertia = Vec3::Constant(0.4 * mass * radius * radius);
  b.pose.x = x;
  b.friction = friction;
  b.restitution = restitution;
  return b;
}

CaseBody case_floor(double friction, double restitution) {
  CaseBody b = case_box({0, -1, 0}, {50, 1, 50}, 1, friction);
  b.fixed = true;
  b.restitution = restitution;
  return b;
}

CaseRun::CaseRun(const CaseScene& scene, const CaseMaker& maker, int hz)
    : scene_(scene), world_(maker(scene, hz)), states_(scene.bodies.size()) {
  read();
}

void CaseRun::read() {
  for (size_t i = 0; i < states_.size(); ++i) states_[i] = world_->state(i);
}

void CaseRun::step() {
  world_->step();
  read();
}

Vec3 CaseRun::angular_momentum(size_t body) const {
  const CaseState& s = states_[body];
  const Vec3 turn = s.pose.inverse_direction(s.omega);
  return s.pose.direction(scene_.bodies[body].inertia.cwiseProduct(turn));
}

double CaseRun::kinetic() const {
  double sum = 0;
  for (size_t i = 0; i < states_.size(); ++i) {
    const CaseBody& b = scene_.bodies[i];
    if (b.fixed) continue;
    const CaseState& s = states_[i];
    sum += 0.5 * b.mass * s.v.squaredNorm() + 0.5 * s.omega.dot(angular_momentum(i));
  }
  return sum;
}

double CaseRun::energy() const {
  double sum = kinetic();
  for (size_t i = 0; i < states_.size(); ++i)
    if (const CaseBody& b = scene_.bodies[i]; !b.fixed)
      sum -= b.mass * scene_.gravity.dot(states_[i].pose.x);
  return sum;
}

Vec3 CaseRun::momentum() const {
  Vec3 sum = Vec3::Zero();
  for (size_t i = 0; i < states_.size(); ++i)
    if (!scene_.bodies[i].fixed) sum += scene_.bodies[i].mass * states_[i].v;
  return sum;
}

}  // namespace tumble::test
