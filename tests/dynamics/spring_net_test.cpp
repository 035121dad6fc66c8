// Nets of springs over one step. References: the scalar recurrences of one spring, worked out by
// hand (leapfrog; backward Euler of a damped oscillator); the closed form of the oscillator, to
// whose order the steps come; the equations of a whole net, into which
// the answer is put; sums of momenta; a thread that has solved nothing before.
#include "engine/dynamics/forces/spring_net.hpp"

#include "engine/core/random.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <thread>
#include <tuple>

#include <Eigen/LU>
#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// A mass on a spring from a wall, along x: displacement `u` and velocity `v` after a step.
struct Oscillator {
  double m, k, c, h;
  double u = 0.1, v = 0;

  void step() {
    SpringNet net;
    net.h = h;
    net.lead = 0.5 * h;
    SpringNet::Node& node = net.nodes.emplace_back();
    node.mass = m;
    SpringNet::Tie& tie = net.ties.emplace_back();
    tie.b = {0, Vec3::Zero(), 1 / m};
    tie.d = Vec3(1 + u + 0.5 * h * v, 0, 0);
    tie.dv = Vec3(v, 0, 0);
    tie.stiffness = k, tie.damping = c, tie.rest_length = 1;
    std::vector<SpringNet::Pull> pulls;
    const SpringNet::Report report = net.solve(pulls);
    CHECK(report.residual <= 1e-8);
    const double a = -pulls[0].force.x() / m;
    u += h * v + 0.5 * h * h * a;
    v += h * a;
  }
};

/// A random net of particles and of bodies that springs hold off their centres.
SpringNet random_net(Random& random, int nodes, int ties, double stiffness, double damping) {
  const auto vector = [&random](double size) -> Vec3 {
    return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  SpringNet net;
  net.h = 1.0 / 60;
  net.lead = 0.5 * net.h;
  for (int i = 0; i < nodes; ++i) {
    SpringNet::Node& n = net.nodes.emplace_back();
    n.mass = random.uniform(0.1, 3);
    n.turns = i % 3 == 0;
    const Vec3 axis = vector(1).normalized();
    const Mat3 R = axis_angle(axis, random.uniform(0, 3)).toRotationMatrix();
    if (n.turns) n.inertia = R * Vec3(0.02, 0.03, 0.04).asDiagonal() * R.transpose();
    n.omega = n.turns ? vector(3) : Vec3::Zero();
    n.dv_free = vector(0.2);
    if (n.turns) n.domega_free = vector(0.2);
  }
  for (int i = 0; i < ties; ++i) {
    SpringNet::Tie& t = net.ties.emplace_back();
    const auto end = [&](uint32_t node) {
      SpringNet::End e{node, Vec3::Zero(), 0};
      if (net.nodes[node].turns) e.arm = vector(0.3);
      e.mobility = 1 / net.nodes[node].mass;
      return e;
    };
    t.a = end(uint32_t(i % nodes));
    t.b = end((uint32_t(i) + 1 + random.below(uint32_t(nodes - 1))) % uint32_t(nodes));
    t.d = vector(1);
    t.dv = vector(2);
    t.stiffness = stiffness * random.uniform(0.5, 2);
    t.damping = damping;
    t.rest_length = random.uniform(0, 1.5);
  }
  return net;
}

/// Jacobian of the velocity of an end.
Eigen::Matrix<double, 3, 6> jacobian(const SpringNet::End& end) {
  Eigen::Matrix<double, 3, 6> J;
  J << Eigen::Matrix3d::Identity(), -dense(skew(end.arm));
  return J;
}

}  // namespace

TEST_CASE("what a step resolves is the leapfrog, to the last digits") {
  Oscillator o{2, 900, 0, 1.0 / 60};  // h^2 k/m = 1/8
  double u = o.u, v = 0;
  for (int i = 0; i < 600; ++i) {
    o.step();
    const double a = -o.k / o.m * (u + 0.5 * o.h * v);
    u += o.h * v + 0.5 * o.h * o.h * a;
    v += o.h * a;
    REQUIRE(o.u == doctest::Approx(u).epsilon(1e-9).scale(0.1));
  }
}

TEST_CASE("a stiff damped spring is backward Euler but for the share that a step resolves") {
  for (const double k : {100.0, 1e4, 1e6, 1e8})
    for (const double c : {0.0, 5.0, 1e4}) {
      Oscillator o{0.5, k, c, 1.0 / 60};
      const double z = o.h * o.h * k / o.m;
      const double resolved = std::min(1.0, 1 / z) * k, rest = k - resolved;
      double u = o.u, v = 0;
      for (int i = 0; i < 50; ++i) {
        o.step();
        // m a = -k_r (u + h v/2) - k_u (u + h v + h^2 a) - c (v + h a)
        const double a = -(resolved * (u + 0.5 * o.h * v) + rest * (u + o.h * v) + c * v) /
                         (o.m + o.h * o.h * rest + o.h * c);
        u += o.h * v + 0.5 * o.h * o.h * a;
        v += o.h * a;
        REQUIRE(o.u == doctest::Approx(u).epsilon(1e-6).scale(0.1));
        REQUIRE(std::fabs(o.u) <= 0.1 * (1 + 1e-9));
      }
    }
}

TEST_CASE("the closed form of the oscillator is met: second order undamped, first order damped") {
  const auto error = [](double c, int steps) {
    Oscillator o{1, 40, c, 1.0 / steps};
    for (int i = 0; i < steps; ++i) o.step();
    const double decay = 0.5 * c / o.m, w = std::sqrt(o.k / o.m - decay * decay);
    return std::fabs(o.u - 0.1 * std::exp(-decay) * (std::cos(w) + decay / w * std::sin(w)));
  };
  for (const int steps : {200, 400}) {
    CHECK(error(0, steps) / error(0, 2 * steps) == doctest::Approx(4).epsilon(0.05));
    CHECK(error(1, steps) / error(1, 2 * steps) == doctest::Approx(2).epsilon(0.1));
  }
  CHECK(error(0, 800) < 1e-6);
}

TEST_CASE("a net's pulls solve its equations: they are those of the velocities that they lead to") {
  Random random(7);
  for (const double stiffness : {1e2, 1e5, 1e7}) {
    const SpringNet net = random_net(random, 12, 30, stiffness, 3);
    std::vector<SpringNet::Pull> pulls;
    CHECK(net.solve(pulls).residual <= 1e-8);
    // What the pulls do to the nodes, over the step, against the pulls of the step's end.
    std::vector<Vec3> dv, dw;
    for (const SpringNet::Node& n : net.nodes) dv.push_back(n.dv_free), dw.push_back(n.domega_free);
    for (size_t i = 0; i < pulls.size(); ++i)
      for (const auto& [end, sign, turn] : {std::tuple{net.ties[i].a, 1.0, pulls[i].turn_a},
                                            {net.ties[i].b, -1.0, pulls[i].turn_b}}) {
        const SpringNet::Node& n = net.nodes[end.node];
        dv[end.node] += net.h * sign / n.mass * pulls[i].force;
        if (n.turns)
          dw[end.node] +=
              net.h * (n.inertia.inverse() * (sign * end.arm.cross(pulls[i].force) + turn));
      }
    const double h2 = net.h * net.h;
    std::vector<double> deg(net.nodes.size(), 0);
    for (const SpringNet::Tie& t : net.ties)
      for (const SpringNet::End& e : {t.a, t.b}) deg[e.node] += t.stiffness * e.mobility;
    double worst = 0, largest = 0;
    for (size_t i = 0; i < pulls.size(); ++i) {
      const SpringNet::Tie& t = net.ties[i];
      const double l = t.d.norm(), z = h2 * (deg[t.a.node] + deg[t.b.node]);
      const double k = t.stiffness * std::min(1.0, 1e5 / z);
      const double rest = k * (1 - 1 / std::clamp(z, 1.0, 1e5));
      const Vec3 n = t.d / l;
      const Mat3 nn = n * n.transpose();
      const Mat3 K = rest * (nn + std::max(0.0, 1 - t.rest_length / l) * (Mat3::Identity() - nn));
      Eigen::Matrix<double, 6, 1> xa, xb;
      xa << dense(dv[t.a.node]), dense(dw[t.a.node]);
      xb << dense(dv[t.b.node]), dense(dw[t.b.node]);
      const Vec3 change = small_vector(jacobian(t.b) * xb - jacobian(t.a) * xa);
      const Vec3 force = k * (l - t.rest_length) * n + t.damping * nn * (t.dv + change) +
                         K * (0.5 * net.h * t.dv + net.h * change);
      worst = std::max(worst, (force - pulls[i].force).norm());
      largest = std::max(largest, force.norm());
    }
    CHECK(largest > 0);
    CHECK(worst < 1e-5 * largest);
  }
}

TEST_CASE("a net changes no momentum, and gains no energy of motion from springs at rest length") {
  Random random(11);
  for (const double stiffness : {1.0, 1e4, 1e9}) {
    SpringNet net = random_net(random, 20, 60, stiffness, 1);
    for (SpringNet::Node& n : net.nodes) {
      n.dv_free = n.domega_free = n.omega = Vec3::Zero();
      n.turns = false;
    }
    for (SpringNet::Tie& t : net.ties) {
      t.a.arm = t.b.arm = Vec3::Zero();
      t.rest_length = t.d.norm();
    }
    std::vector<Vec3> v(net.nodes.size());
    for (Vec3& x : v) x = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    for (SpringNet::Tie& t : net.ties) t.dv = v[t.b.node] - v[t.a.node];
    std::vector<SpringNet::Pull> pulls;
    net.solve(pulls);
    Vec3 before = Vec3::Zero(), after = Vec3::Zero();
    double energy_before = 0, energy_after = 0;
    const auto sum = [&](Vec3& momentum, double& energy) {
      for (size_t i = 0; i < v.size(); ++i) {
        momentum += net.nodes[i].mass * v[i];
        energy += 0.5 * net.nodes[i].mass * v[i].squaredNorm();
      }
    };
    sum(before, energy_before);
    for (size_t i = 0; i < pulls.size(); ++i) {
      v[net.ties[i].a.node] += net.h / net.nodes[net.ties[i].a.node].mass * pulls[i].force;
      v[net.ties[i].b.node] -= net.h / net.nodes[net.ties[i].b.node].mass * pulls[i].force;
    }
    sum(after, energy_after);
    CHECK((after - before).norm() < 1e-12 * before.norm() + 1e-12);
    CHECK(energy_after <= energy_before * (1 + 1e-9));
  }
}

TEST_CASE("nets that a thread solved before leave no trace in the bits of the next") {
  Random random(11);
  std::vector<SpringNet> nets;
  for (const auto& [nodes, ties] : {std::pair{3, 4}, {40, 90}, {7, 9}, {25, 60}, {2, 1}})
    nets.push_back(random_net(random, nodes, ties, 2000, 3));
  struct Answer {
    SpringNet::Report report;
    std::vector<SpringNet::Pull> pulls;
  };
  const auto solve = [](const SpringNet& net) {
    Answer out;
    out.report = net.solve(out.pulls);
    return out;
  };
  for (const SpringNet& net : nets) {
    const Answer after_others = solve(net);
    Answer first;
    std::thread([&] { first = solve(net); }).join();
    CHECK(after_others.report.iterations == first.report.iterations);
    CHECK(after_others.report.residual == first.report.residual);
    REQUIRE(after_others.pulls.size() == first.pulls.size());
    for (size_t i = 0; i < first.pulls.size(); ++i) {
      const SpringNet::Pull &a = after_others.pulls[i], &b = first.pulls[i];
      CHECK((a.force == b.force && a.elastic == b.elastic));
      CHECK((a.turn_a == b.turn_a && a.turn_b == b.turn_b));
    }
  }
}
