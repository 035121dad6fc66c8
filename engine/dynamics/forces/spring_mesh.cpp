#include "engine/dynamics/forces/spring_mesh.hpp"

#include "engine/dynamics/forces/anchor.hpp"
#include "engine/dynamics/forces/spring_pulls.hpp"
#include "engine/dynamics/forces/tolerances.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

bool is_strength(double value) {
  return std::isfinite(value) && value >= 0;
}

std::string link_fault(const SpringMesh& mesh) {
  for (size_t i = 0; i < mesh.links.size(); ++i) {
    const SpringMesh::Link& l = mesh.links[i];
    if (l.a >= mesh.nodes.size() || l.b >= mesh.nodes.size() || l.a == l.b)
      return fmt::format("link {} joins nodes {} and {}, of {} nodes", i, l.a, l.b,
                         mesh.nodes.size());
    if (!is_strength(l.rest_length) || !is_strength(l.stiffness) || !is_strength(l.damping))
      return fmt::format(
          "link {} needs finite numbers >= 0, got rest length {} m, stiffness {} "
          "N/m, damping {} N s/m",
          i, l.rest_length, l.stiffness, l.damping);
  }
  return {};
}

std::string bend_fault(const SpringMesh& mesh) {
  for (size_t i = 0; i < mesh.bends.size(); ++i) {
    const SpringMesh::Bend& b = mesh.bends[i];
    if (b.count > b.node.size()) return fmt::format("bend {} has {} nodes", i, b.count);
    double sum = 0, size = 0;
    for (uint32_t k = 0; k < b.count; ++k) {
      if (b.node[k] >= mesh.nodes.size())
        return fmt::format("bend {} has node {}, of {} nodes", i, b.node[k], mesh.nodes.size());
      sum += b.weight[k];
      size += std::fabs(b.weight[k]);
    }
    if (!(std::fabs(sum) <= tolerances::bend_rounding * size))
      return fmt::format("the weights of bend {} add up to {}, not to 0", i, sum);
    if (!is_strength(b.stiffness) || !is_strength(b.damping))
      return fmt::format(
          "bend {} needs finite numbers >= 0, got stiffness {} N/m, damping {} N s/m", i,
          b.stiffness, b.damping);
  }
  return {};
}

std::string drawing_fault(const SpringMesh& mesh) {
  const auto known = [&mesh](uint32_t node) { return node < mesh.nodes.size(); };
  for (const SpringMesh::Face& f : mesh.faces)
    if (!std::ranges::all_of(f.node, known)) return "a face has a node that there is not";
  for (const SpringMesh::Strand& s : mesh.strands)
    if (!known(s.a) || !known(s.b)) return "a strand has a node that there is not";
  return {};
}

/// A mesh as if nothing else pulled at its nodes.
void apply_alone(const SpringMeshDef& def, ForceContext& context) {
  const SpringMeshDef* alone = &def;
  NetPulls pulls;
  pull_springs({{}, {&alone, 1}}, context, {}, pulls);
  for (size_t i = 0; i < def.mesh->nodes.size(); ++i) {
    add_force(def.mesh->nodes[i], pulls.meshes[0][i].force, context);
    if (RigidBody* body = pulled_body(def.mesh->nodes[i], context))
      body->torque += pulls.meshes[0][i].turn;
  }
}

}  // namespace

std::string SpringMeshDef::fault() const {
  if (!mesh) return "it has no mesh";
  for (const auto& find : {link_fault, bend_fault, drawing_fault})
    if (std::string found = find(*mesh); !found.empty()) return found;
  return {};
}

void locate(const SpringMesh& mesh, const ForceContext& context, std::vector<MeshNode>& out) {
  out.resize(mesh.nodes.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const auto at = locate(mesh.nodes[i], context);
    out[i] = at ? MeshNode{true, at->x_world, at->v_world} : MeshNode{};
  }
}

void apply(const SpringMeshDef& def, ForceContext& context) {
  if (!context.momentary) return apply_alone(def, context);
  std::vector<MeshNode> nodes;
  locate(*def.mesh, context, nodes);
  std::vector<Vec3> sums(nodes.size(), Vec3::Zero());
  for_pulls(*def.mesh, nodes,
            [&sums](uint32_t node, const Vec3& pull, const Vec3&) { sums[node] += pull; });
  for (size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].there) add_force(def.mesh->nodes[i], sums[i], context);
}

double potential_energy(const SpringMeshDef& def, const ForceContext& context) {
  std::vector<MeshNode> nodes;
  locate(*def.mesh, context, nodes);
  double sum = 0;
  for (const SpringMesh::Link& l : def.mesh->links) {
    if (!nodes[l.a].there || !nodes[l.b].there) continue;
    const double stretch = (nodes[l.b].x - nodes[l.a].x).norm() - l.rest_length;
    sum += 0.5 * l.stiffness * stretch * stretch;
  }
  for (const SpringMesh::Bend& b : def.mesh->bends) {
    Vec3 q = Vec3::Zero();
    bool whole = true;
    for (uint32_t i = 0; i < b.count; ++i) {
      whole = whole && nodes[b.node[i]].there;
      q += b.weight[i] * nodes[b.node[i]].x;
    }
    if (whole) sum += 0.5 * b.stiffness * q.squaredNorm();
  }
  return sum;
}

}  // namespace tumble
