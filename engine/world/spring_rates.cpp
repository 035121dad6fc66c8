#include "engine/world/spring_rates.hpp"

#include "engine/dynamics/forces/anchor.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

class SpringRates {
 public:
  explicit SpringRates(const ForceContext& context)
      : context_(context),
        stiff_(context.bodies.bodies.size(), 0),
        damped_(context.bodies.bodies.size(), 0) {}

  void add(const SpringDef& spring) {
    add(node_of(spring.a), node_of(spring.b), spring.stiffness, spring.damping);
  }

  void add(const SpringMesh& mesh) {
    std::vector<Node> nodes;
    for (const Anchor& a : mesh.nodes) nodes.push_back(node_of(a));
    for (const SpringMesh::Link& link : mesh.links)
      add(nodes[link.a], nodes[link.b], link.stiffness, link.damping);
    for (const SpringMesh::Bend& bend : mesh.bends) {
      double all = 0;
      for (uint32_t i = 0; i < bend.count; ++i)
        if (nodes[bend.node[i]].body) all += std::fabs(bend.weight[i]);
      for (uint32_t i = 0; i < bend.count; ++i) {
        const double share = std::fabs(bend.weight[i]) * all;
        add(nodes[bend.node[i]], share * bend.stiffness, share * bend.damping);
      }
    }
  }

  std::vector<double> take() {
    for (size_t i = 0; i < stiff_.size(); ++i)
      stiff_[i] = std::max(std::sqrt(stiff_[i]), damped_[i]);
    return std::move(stiff_);
  }

 private:
  struct Node {
    const RigidBody* body = nullptr;
    /// Upper bound of its mobility in any direction [1/kg].
    double mobility = 0;
  };
  Node node_of(const Anchor& a) const {
    const RigidBody* body = pulled_body(a, context_);
    if (!body || !body->dynamic()) return {};
    return {body, (mobility(a, context_).cwiseAbs() * Vec3::Ones()).maxCoeff()};
  }
  /// A spring between two ends. The row of each end has one block per end that can move.
  void add(const Node& a, const Node& b, double stiffness, double damping) {
    const double entries = a.body && b.body ? 2 : 1;
    add(a, entries * stiffness, entries * damping);
    add(b, entries * stiffness, entries * damping);
  }
  void add(const Node& node, double stiffness, double damping) {
    if (!node.body) return;
    const auto slot = size_t(node.body - context_.bodies.bodies.data());
    stiff_[slot] += stiffness * node.mobility;
    damped_[slot] += damping * node.mobility;
  }

  const ForceContext& context_;
  std::vector<double> stiff_, damped_;  ///< row sums of M^-1 K [1/s2] and of M^-1 C [1/s]
};

}  // namespace

std::vector<double> spring_rates(std::span<const std::optional<ForceDef>> forces,
                                 const ForceContext& context) {
  SpringRates rates(context);
  bool any = false;
  for (const std::optional<ForceDef>& force : forces) {
    if (!force) continue;
    if (const auto* spring = std::get_if<SpringDef>(&*force)) {
      rates.add(*spring);
      any = true;
    } else if (const auto* mesh = std::get_if<SpringMeshDef>(&*force)) {
      rates.add(*mesh->mesh);
      any = true;
    }
  }
  return any ? rates.take() : std::vector<double>{};
}

}  // namespace tumble
