#include "engine/world/break_springs.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace tumble {
namespace {

using Edge = std::pair<uint32_t, uint32_t>;

Edge edge(uint32_t a, uint32_t b) {
  return std::minmax(a, b);
}

/// The edges of links that are stretched by more than `limit`.
std::set<Edge> torn_edges(const SpringMesh& mesh, const std::vector<MeshNode>& nodes,
                          double limit) {
  std::set<Edge> torn;
  for (const SpringMesh::Link& l : mesh.links) {
    if (!nodes[l.a].there || !nodes[l.b].there) continue;
    const double length = (nodes[l.b].x - nodes[l.a].x).norm();
    if (length > (1 + limit) * l.rest_length) torn.insert(edge(l.a, l.b));
  }
  return torn;
}

/// Whether any two of these nodes are the ends of a broken link.
bool over(const std::set<Edge>& torn, std::span<const uint32_t> nodes) {
  for (size_t i = 0; i < nodes.size(); ++i)
    for (size_t k = i + 1; k < nodes.size(); ++k)
      if (torn.contains(edge(nodes[i], nodes[k]))) return true;
  return false;
}

SpringMesh without(const SpringMesh& mesh, const std::set<Edge>& torn) {
  SpringMesh out = mesh;
  std::erase_if(out.links,
                [&](const SpringMesh::Link& l) { return torn.contains(edge(l.a, l.b)); });
  std::erase_if(out.bends, [&](const SpringMesh::Bend& b) {
    return over(torn, std::span(b.node).first(b.count));
  });
  std::erase_if(out.faces, [&](const SpringMesh::Face& f) { return over(torn, f.node); });
  std::erase_if(out.strands,
                [&](const SpringMesh::Strand& s) { return torn.contains(edge(s.a, s.b)); });
  return out;
}

}  // namespace

void break_springs(WorldState& s) {
  for (uint32_t slot = 0; slot < s.forces.size(); ++slot) {
    auto* def = s.forces[slot] ? std::get_if<SpringMeshDef>(&*s.forces[slot]) : nullptr;
    if (!def || !(def->break_strain > 0)) continue;
    const ForceContext context = s.force_context();
    std::vector<MeshNode> nodes;
    locate(*def->mesh, context, nodes);
    const std::set<Edge> torn = torn_edges(*def->mesh, nodes, def->break_strain);
    if (torn.empty()) continue;
    const double before = potential_energy(*def, context);
    def->mesh = std::make_shared<const SpringMesh>(without(*def->mesh, torn));
    s.ledger.book_force(slot, {.balance = potential_energy(*def, context) - before});
  }
}

}  // namespace tumble
