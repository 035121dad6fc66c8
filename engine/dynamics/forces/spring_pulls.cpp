#include "engine/dynamics/forces/spring_pulls.hpp"

#include "engine/core/disjoint_sets.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/forces/anchor.hpp"
#include "engine/dynamics/forces/tolerances.hpp"
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
    out.x = body.pose.x + context_->lead * body.v;
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
    out.x = p.x[i] + context_->lead * p.v[i];
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

/// The ends of a tie, and how far they are apart.
void set_ends(SpringNet::Tie& tie, const Held& a, double lead_a, const Held& b, double lead_b) {
  tie.d = (b.at.x_world + lead_b * b.at.v_world) - (a.at.x_world + lead_a * a.at.v_world);
  tie.dv = b.at.v_world - a.at.v_world;
  const double length2 = tie.d.squaredNorm();
  const auto end = [&](const Held& h) {
    const double along = length2 > 0 ? tie.d.dot(h.mobility * tie.d) / length2 : 0;
    return SpringNet::End{h.node, h.arm, along};
  };
  tie.a = end(a), tie.b = end(b);
}

SpringNet::Tie tie_of(const SpringDef& spring, const Held& a, const Held& b,
                      const ForceContext& context) {
  SpringNet::Tie tie;
  set_ends(tie, a, lead_of(spring.a, context), b, lead_of(spring.b, context));
  tie.stiffness = spring.stiffness;
  tie.damping = spring.damping;
  tie.rest_length = spring.rest_length;
  return tie;
}

/// What a row of a net is of: springs are of source 0, the mesh with index i of source i + 1.
struct RowOrigin {
  uint32_t source = 0;
  uint32_t index = 0;  ///< of the spring, link or bend
};

/// A net, and what its rows are of.
struct NumberedNet {
  SpringNet net;
  std::vector<RowOrigin> ties, stencils;
  bool meshed = false;
};

/// The nodes of a mesh in a tick; nothing where one is gone.
using MeshHeld = std::vector<std::optional<Held>>;

/// Makes nets out of springs, in memory that it keeps from tick to tick.
class NetMaker {
 public:
  /// Valid until the next call.
  std::span<NumberedNet> make(const NetSprings& springs, const ForceContext& context,
                              std::span<const uint8_t> supported) {
    numbers_.start(context, supported);
    ties_.clear();
    of_.clear();
    stencils_.clear();
    stencil_of_.clear();
    tie_springs(springs.springs, context);
    meshes_.resize(springs.meshes.size());
    for (uint32_t m = 0; m < springs.meshes.size(); ++m)
      tie_mesh(*springs.meshes[m]->mesh, m, context);
    join_ends();
    net_of_.assign(numbers_.nodes.size(), SpringNet::fixed);
    own_number_.assign(numbers_.nodes.size(), SpringNet::fixed);
    made_ = 0;
    for (size_t i = 0; i < ties_.size(); ++i) {
      NumberedNet& net = net_of(ties_[i].a.node, ties_[i].b.node, context);
      move_end(ties_[i].a, net.net);
      move_end(ties_[i].b, net.net);
      net.net.ties.push_back(ties_[i]);
      net.ties.push_back(of_[i]);
      net.meshed = net.meshed || of_[i].source > 0;
    }
    for (size_t i = 0; i < stencils_.size(); ++i) {
      SpringNet::Stencil& s = stencils_[i];
      NumberedNet& net = net_of(any_node(s), SpringNet::fixed, context);
      for (uint32_t k = 0; k < s.count; ++k) move_end(s.end[k], net.net);
      net.net.stencils.push_back(s);
      net.stencils.push_back(stencil_of_[i]);
      net.meshed = true;
    }
    return std::span(nets_).first(made_);
  }
  const MeshHeld& held(size_t mesh) const { return meshes_[mesh]; }
  /// The number in its net of what a node of a mesh is.
  uint32_t number_in_net(const Held& held) const {
    return held.node == SpringNet::fixed ? SpringNet::fixed : own_number_[held.node];
  }
  /// The net that a node is in, among those made; fixed: none.
  uint32_t net_number(const Held& held) {
    return held.node == SpringNet::fixed ? SpringNet::fixed : net_of_[sets_.root(held.node)];
  }

 private:
  void tie_springs(std::span<const SpringDef* const> springs, const ForceContext& context) {
    for (uint32_t i = 0; i < springs.size(); ++i) {
      const auto a = numbers_.hold(springs[i]->a), b = numbers_.hold(springs[i]->b);
      if (!a || !b || (a->node == SpringNet::fixed && b->node == SpringNet::fixed)) continue;
      ties_.push_back(tie_of(*springs[i], *a, *b, context));
      of_.push_back({0, i});
    }
  }
  void tie_mesh(const SpringMesh& mesh, uint32_t number, const ForceContext& context) {
    MeshHeld& held = meshes_[number];
    held.clear();
    leads_.clear();
    for (const Anchor& anchor : mesh.nodes) {
      held.push_back(numbers_.hold(anchor));
      if (held.back() && held.back()->node != SpringNet::fixed)
        numbers_.nodes[held.back()->node].meshed = true;
      leads_.push_back(lead_of(anchor, context));
    }
    for (uint32_t i = 0; i < mesh.links.size(); ++i) {
      const SpringMesh::Link& link = mesh.links[i];
      const auto &a = held[link.a], &b = held[link.b];
      if (!a || !b || a->node == b->node) continue;
      SpringNet::Tie& tie = ties_.emplace_back();
      set_ends(tie, *a, leads_[link.a], *b, leads_[link.b]);
      tie.stiffness = link.stiffness;
      tie.damping = link.damping;
      tie.rest_length = link.rest_length;
      of_.push_back({number + 1, i});
    }
    for (uint32_t i = 0; i < mesh.bends.size(); ++i) bow_mesh(mesh, number, i);
  }
  void bow_mesh(const SpringMesh& mesh, uint32_t number, uint32_t index) {
    const SpringMesh::Bend& bend = mesh.bends[index];
    SpringNet::Stencil s;
    s.count = bend.count;
    s.weight = bend.weight;
    s.stiffness = bend.stiffness;
    s.damping = bend.damping;
    for (uint32_t k = 0; k < bend.count; ++k) {
      const auto& at = meshes_[number][bend.node[k]];
      if (!at) return;
      s.end[k] = {at->node, at->arm, at->mobility.trace() / 3};
      s.q += bend.weight[k] * (at->at.x_world + leads_[bend.node[k]] * at->at.v_world);
      s.dq += bend.weight[k] * at->at.v_world;
    }
    if (any_node(s) == SpringNet::fixed) return;
    stencils_.push_back(s);
    stencil_of_.push_back({number + 1, index});
  }
  static uint32_t any_node(const SpringNet::Stencil& s) {
    for (uint32_t k = 0; k < s.count; ++k)
      if (s.end[k].node != SpringNet::fixed) return s.end[k].node;
    return SpringNet::fixed;
  }
  void join_ends() {
    sets_.reset(numbers_.nodes.size());
    for (const SpringNet::Tie& t : ties_)
      if (t.a.node != SpringNet::fixed && t.b.node != SpringNet::fixed)
        sets_.join(t.a.node, t.b.node);
    for (const SpringNet::Stencil& s : stencils_)
      for (uint32_t k = 0; k < s.count; ++k)
        if (s.end[k].node != SpringNet::fixed) sets_.join(any_node(s), s.end[k].node);
  }
  NumberedNet& net_of(uint32_t node, uint32_t other, const ForceContext& context) {
    uint32_t& number = net_of_[sets_.root(node != SpringNet::fixed ? node : other)];
    if (number != SpringNet::fixed) return nets_[number];
    number = uint32_t(made_++);
    if (made_ > nets_.size()) nets_.emplace_back();
    NumberedNet& net = nets_[number];
    net.net.h = context.h;
    net.net.lead = context.lead;
    net.net.nodes.clear();
    net.net.ties.clear();
    net.net.stencils.clear();
    net.ties.clear();
    net.stencils.clear();
    net.meshed = false;
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
  std::vector<RowOrigin> of_;  ///< by tie
  std::vector<SpringNet::Stencil> stencils_;
  std::vector<RowOrigin> stencil_of_;
  std::vector<MeshHeld> meshes_;
  std::vector<double> leads_;  ///< by node of the mesh under way
  DisjointSets sets_;
  std::vector<uint32_t> net_of_;      ///< by the node that stands for its set
  std::vector<uint32_t> own_number_;  ///< by node: its number in its net
  std::vector<NumberedNet> nets_;
  size_t made_ = 0;  ///< of `nets_`; the others are kept for their memory
};

/// Adds what a net with meshes does to its springs and nodes.
void take_answer(const NumberedNet& net, const SpringNet::Answer& answer, const NetSprings& springs,
                 NetPulls& out) {
  for (size_t k = 0; k < net.ties.size(); ++k) {
    const auto [source, index] = net.ties[k];
    const SpringNet::Pull& pull = answer.ties[k];
    if (source == 0) {
      out.springs[index] = pull;
      continue;
    }
    const SpringMesh::Link& link = springs.meshes[source - 1]->mesh->links[index];
    NodePull &a = out.meshes[source - 1][link.a], &b = out.meshes[source - 1][link.b];
    a.force += pull.force, b.force -= pull.force;
    a.elastic += pull.elastic, b.elastic -= pull.elastic;
    a.turn += pull.turn_a, b.turn += pull.turn_b;
  }
  for (size_t k = 0; k < net.stencils.size(); ++k) {
    const auto [source, index] = net.stencils[k];
    const SpringMesh::Bend& bend = springs.meshes[source - 1]->mesh->bends[index];
    for (uint32_t i = 0; i < bend.count; ++i) {
      NodePull& node = out.meshes[source - 1][bend.node[i]];
      node.force -= bend.weight[i] * answer.stencils[k].force;
      node.elastic -= bend.weight[i] * answer.stencils[k].elastic;
    }
  }
}

}  // namespace

void pull_springs(const NetSprings& springs, const ForceContext& context,
                  std::span<const uint8_t> supported, NetPulls& out) {
  out.springs.assign(springs.springs.size(), {});
  out.meshes.resize(springs.meshes.size());
  for (size_t m = 0; m < springs.meshes.size(); ++m)
    out.meshes[m].assign(springs.meshes[m]->mesh->nodes.size(), {});
  if (springs.springs.empty() && springs.meshes.empty()) return;
  thread_local NetMaker maker;
  thread_local std::vector<SpringNet::Pull> pulls;
  thread_local std::vector<SpringNet::Answer> answers;
  const std::span<NumberedNet> nets = maker.make(springs, context, supported);
  answers.resize(std::max(answers.size(), nets.size()));
  for (size_t n = 0; n < nets.size(); ++n) {
    if (stop_requested()) return;
    if (nets[n].meshed) {
      nets[n].net.ease = tolerances::stiff_ease;
      nets[n].net.solve_meshed(answers[n]);
      take_answer(nets[n], answers[n], springs, out);
      continue;
    }
    nets[n].net.solve(pulls);
    for (size_t k = 0; k < pulls.size(); ++k) out.springs[nets[n].ties[k].index] = pulls[k];
  }
  // What the velocities of a node need besides goes to the first node of a mesh that is there.
  for (size_t m = 0; m < springs.meshes.size(); ++m)
    for (size_t i = 0; i < out.meshes[m].size(); ++i) {
      const auto& held = maker.held(m)[i];
      const uint32_t net = held ? maker.net_number(*held) : SpringNet::fixed;
      if (net == SpringNet::fixed || !nets[net].meshed) continue;
      const uint32_t node = maker.number_in_net(*held);
      Vec3 &force = answers[net].rest_force[node], &torque = answers[net].rest_torque[node];
      out.meshes[m][i].force += force;
      out.meshes[m][i].turn += torque - held->arm.cross(force);
      force.setZero();
      torque.setZero();
    }
}

void add_pull(const SpringDef& spring, const SpringNet::Pull& pull, ForceContext& context) {
  add_force(spring.a, pull.force, context);
  add_force(spring.b, -pull.force, context);
  if (RigidBody* body = pulled_body(spring.a, context)) body->torque += pull.turn_a;
  if (RigidBody* body = pulled_body(spring.b, context)) body->torque += pull.turn_b;
}

}  // namespace tumble
