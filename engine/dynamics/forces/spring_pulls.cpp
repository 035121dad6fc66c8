#include "engine/dynamics/forces/spring_pulls.hpp"

#include "engine/core/disjoint_sets.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/forces/anchor.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Where an anchor is, and what moves with it.
struct Held {
  AnchorState at;
  uint32_t node = SpringNet::fixed;  ///< among all nodes
  Vec3 arm = Vec3::Zero();
  Mat3 mobility = Mat3::Zero();
};

/// Gives numbers to what springs can move: bodies by slot, and particles behind them.
class NodeNumbers {
 public:
  void start(const ForceContext& context, std::span<const uint8_t> supported) {
    context_ = &context;
    supported_ = supported;
    nodes.clear();
    first_.clear();
    size_t next = context.bodies.bodies.size();
    for (const ParticleSystem& p : context.particles) {
      first_.push_back(next);
      next += p.size();
    }
    number_.assign(next, SpringNet::fixed);
  }

  /// Nothing where what the anchor was on is gone.
  std::optional<Held> hold(const Anchor& anchor) {
    const auto at = locate(anchor, *context_);
    if (!at) return std::nullopt;
    Held out{*at, SpringNet::fixed, Vec3::Zero(), Mat3::Zero()};
    if (const RigidBody* body = pulled_body(anchor, *context_)) {
      if (!body->dynamic()) return out;
      out.node =
          node(size_t(body - context_->bodies.bodies.data()), [&] { return node_of(*body); });
      if (nodes[out.node].turns) out.arm = at->x_world - body->pose.x;
      out.mobility = mobility_of(*body, out.arm);
    } else if (anchor.kind == Anchor::Kind::particle) {
      const ParticleSystem& p = context_->particles[anchor.particles.index];
      const size_t i = p.find(anchor.particle);
      out.node = node(first_[anchor.particles.index] + i, [&] { return node_of(p, i); });
      out.mobility = Mat3::Identity() / p.mass[i];
    }
    return out;
  }

  std::vector<SpringNet::Node> nodes;

 private:
  template <class Make>
  uint32_t node(size_t place, const Make& make) {
    if (number_[place] == SpringNet::fixed) {
      number_[place] = uint32_t(nodes.size());
      nodes.push_back(make());
    }
    return number_[place];
  }
  SpringNet::Node node_of(const RigidBody& body) const {
    SpringNet::Node out;
    out.mass = body.mass;
    out.turns = !body.inverse_inertia_body.isZero(0);
    const size_t slot = size_t(&body - context_->bodies.bodies.data());
    const bool free = slot >= supported_.size() || !supported_[slot];
    const double h = context_->h;
    if (free)
      out.dv_free = h * (body.gravity_scale * context_->gravity + body.inverse_mass * body.force);
    if (!out.turns) return out;
    out.inertia = body.inertia_world();
    out.omega = body.omega;
    if (free) out.domega_free = h * (body.inverse_inertia_world() * body.torque);
    return out;
  }
  SpringNet::Node node_of(const ParticleSystem& p, size_t i) const {
    SpringNet::Node out;
    out.mass = p.mass[i];
    out.dv_free = context_->h * (p.gravity_scale * context_->gravity + p.force[i] / p.mass[i]);
    return out;
  }
  static Mat3 mobility_of(const RigidBody& body, const Vec3& arm) {
    const Mat3 r = skew(arm);
    return Mat3::Identity() * body.inverse_mass - r * body.inverse_inertia_world() * r;
  }

  const ForceContext* context_ = nullptr;
  std::span<const uint8_t> supported_;
  std::vector<size_t> first_;     ///< by particle system: number of its first particle
  std::vector<uint32_t> number_;  ///< of the node
};

SpringNet::Tie tie_of(const SpringDef& spring, const Held& a, const Held& b,
                      const ForceContext& context) {
  SpringNet::Tie tie;
  tie.d = (b.at.x_world + lead_of(spring.b, context) * b.at.v_world) -
          (a.at.x_world + lead_of(spring.a, context) * a.at.v_world);
  tie.dv = b.at.v_world - a.at.v_world;
  const double length2 = tie.d.squaredNorm();
  const auto end = [&](const Held& h) {
    const double along = length2 > 0 ? tie.d.dot(h.mobility * tie.d) / length2 : 0;
    return SpringNet::End{h.node, h.arm, along};
  };
  tie.a = end(a), tie.b = end(b);
  tie.stiffness = spring.stiffness;
  tie.damping = spring.damping;
  tie.rest_length = spring.rest_length;
  return tie;
}

/// A net, and which of all springs its ties are.
struct NumberedNet {
  SpringNet net;
  std::vector<uint32_t> springs;  ///< by tie: index of the spring
};

/// Makes nets out of springs, in memory that it keeps from tick to tick.
class NetMaker {
 public:
  /// Valid until the next call.
  std::span<NumberedNet> make(std::span<const SpringDef* const> springs,
                              const ForceContext& context, std::span<const uint8_t> supported) {
    tie_springs(springs, context, supported);
    sets_.reset(numbers_.nodes.size());
    for (const SpringNet::Tie& t : ties_)
      if (t.a.node != SpringNet::fixed && t.b.node != SpringNet::fixed)
        sets_.join(t.a.node, t.b.node);
    net_of_.assign(numbers_.nodes.size(), SpringNet::fixed);
    own_number_.assign(numbers_.nodes.size(), SpringNet::fixed);
    made_ = 0;
    for (size_t i = 0; i < ties_.size(); ++i) {
      NumberedNet& net = net_of(ties_[i], context);
      move_end(ties_[i].a, net.net);
      move_end(ties_[i].b, net.net);
      net.net.ties.push_back(ties_[i]);
      net.springs.push_back(of_[i]);
    }
    return std::span(nets_).first(made_);
  }

 private:
  void tie_springs(std::span<const SpringDef* const> springs, const ForceContext& context,
                   std::span<const uint8_t> supported) {
    numbers_.start(context, supported);
    ties_.clear();
    of_.clear();
    for (uint32_t i = 0; i < springs.size(); ++i) {
      const auto a = numbers_.hold(springs[i]->a), b = numbers_.hold(springs[i]->b);
      if (!a || !b || (a->node == SpringNet::fixed && b->node == SpringNet::fixed)) continue;
      ties_.push_back(tie_of(*springs[i], *a, *b, context));
      of_.push_back(i);
    }
  }
  NumberedNet& net_of(const SpringNet::Tie& tie, const ForceContext& context) {
    uint32_t& number =
        net_of_[sets_.root(tie.a.node != SpringNet::fixed ? tie.a.node : tie.b.node)];
    if (number != SpringNet::fixed) return nets_[number];
    number = uint32_t(made_++);
    if (made_ > nets_.size()) nets_.emplace_back();
    NumberedNet& net = nets_[number];
    net.net.h = context.h;
    net.net.lead = context.lead;
    net.net.nodes.clear();
    net.net.ties.clear();
    net.springs.clear();
    return net;
  }
  /// Takes the node of an end over into a net of its own numbers.
  void move_end(SpringNet::End& end, SpringNet& net) {
    if (end.node == SpringNet::fixed) return;
    uint32_t& number = own_number_[end.node];
    if (number == SpringNet::fixed) {
      number = uint32_t(net.nodes.size());
      net.nodes.push_back(numbers_.nodes[end.node]);
    }
    end.node = number;
  }

  NodeNumbers numbers_;
  std::vector<SpringNet::Tie> ties_;
  std::vector<uint32_t> of_;  ///< by tie: index of the spring
  DisjointSets sets_;
  std::vector<uint32_t> net_of_;      ///< by the node that stands for its set
  std::vector<uint32_t> own_number_;  ///< by node: its number in its net
  std::vector<NumberedNet> nets_;
  size_t made_ = 0;  ///< of `nets_`; the others are kept for their memory
};

}  // namespace

void pull_springs(std::span<const SpringDef* const> springs, const ForceContext& context,
                  std::span<const uint8_t> supported, std::vector<SpringNet::Pull>& out) {
  out.assign(springs.size(), {});
  if (springs.empty()) return;
  thread_local NetMaker maker;
  thread_local std::vector<SpringNet::Pull> pulls;
  for (const NumberedNet& net : maker.make(springs, context, supported)) {
    if (stop_requested()) return;
    net.net.solve(pulls);
    for (size_t k = 0; k < pulls.size(); ++k) out[net.springs[k]] = pulls[k];
  }
}

void add_pull(const SpringDef& spring, const SpringNet::Pull& pull, ForceContext& context) {
  add_force(spring.a, pull.force, context);
  add_force(spring.b, -pull.force, context);
  if (RigidBody* body = pulled_body(spring.a, context)) body->torque += pull.turn_a;
  if (RigidBody* body = pulled_body(spring.b, context)) body->torque += pull.turn_b;
}

}  // namespace tumble
