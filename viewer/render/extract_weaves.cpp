#include "viewer/render/extract_weaves.hpp"

#include "engine/math/rotation.hpp"
#include "viewer/render/builtin_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

const SpringMesh* drawn_mesh(const ForceFrame& force) {
  const auto* def = std::get_if<SpringMeshDef>(&force.def);
  if (!def || !def->mesh || force.points.size() != def->mesh->nodes.size()) return nullptr;
  return def->mesh->faces.empty() && def->mesh->strands.empty() ? nullptr : def->mesh.get();
}

/// Positions of the nodes between two frames; the earlier frame is only used if it has the same
/// nodes.
std::vector<Vec3> nodes_between(const Frame& from, const ForceFrame& to, double s) {
  const auto then = std::ranges::find(from.forces, to.id, &ForceFrame::id);
  if (s >= 1 || then == from.forces.end() || then->points.size() != to.points.size())
    return to.points;
  std::vector<Vec3> out;
  for (size_t i = 0; i < to.points.size(); ++i)
    out.push_back(then->points[i] + s * (to.points[i] - then->points[i]));
  return out;
}

/// A mesh relative to an origin nearby, so that single precision suffices far from the world's
/// origin.
struct Nearby {
  Vec3 origin = Vec3::Zero();
  explicit Nearby(const std::vector<Vec3>& nodes) {
    for (const Vec3& x : nodes)
      if (x.allFinite()) {
        origin = x;
        return;
      }
  }
  Pose pose() const { return {origin, Quat::Identity()}; }
};

void add_instance(MeshRef mesh, const Nearby& nearby, const Vec3f& colour, float roughness,
                  RenderScene& out) {
  if (!mesh) return;
  Paint paint;
  paint.colour = colour;
  paint.roughness = roughness;
  out.instances.push_back(mesh_instance(std::move(mesh), nearby.pose(), Vec3::Ones(), paint));
}

void add_surface(const SpringMesh& mesh, const std::vector<Vec3>& nodes, RenderScene& out) {
  const Nearby nearby(nodes);
  std::vector<Vec3f> positions(nodes.size(), Vec3f::Zero()), normals(nodes.size());
  std::vector<Vec3> sums(nodes.size(), Vec3::Zero());
  std::array<std::vector<uint32_t>, 2> indices;
  for (size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].allFinite()) positions[i] = (nodes[i] - nearby.origin).cast<float>();
  for (const SpringMesh::Face& face : mesh.faces) {
    const auto& [a, b, c] = face.node;
    const Vec3 cross = (nodes[b] - nodes[a]).cross(nodes[c] - nodes[a]);
    if (!cross.allFinite()) continue;  // a node no longer exists
    for (const uint32_t node : face.node) sums[node] += cross;
    std::vector<uint32_t>& list = indices[face.tone != 0];
    list.insert(list.end(), face.node.begin(), face.node.end());
  }
  for (size_t i = 0; i < nodes.size(); ++i) {
    const double length = sums[i].norm();
    normals[i] = length > 0 ? Vec3f((sums[i] / length).cast<float>()) : Vec3f(Vec3f::UnitY());
  }
  constexpr float cloth_roughness = 0.85f;
  for (size_t tone = 0; tone < 2; ++tone)
    if (!indices[tone].empty())
      add_instance(make_mesh(positions, normals, std::move(indices[tone])), nearby,
                   tone == 0 ? mesh.drawing.colour : mesh.drawing.second_colour, cloth_roughness,
                   out);
}

/// Tubes around polylines of nodes: a ring of vertices at every node, carried along with the least
/// rotation (parallel transport).
class Tubes {
 public:
  Tubes(const std::vector<Vec3>& nodes, double radius)
      : nodes_(nodes), nearby_(nodes), radius_(radius) {}

  void add(const std::vector<uint32_t>& line) {
    Vec3 side = Vec3::Zero();
    for (size_t i = 0; i < line.size(); ++i) {
      const Vec3 before = at(line[i]) - at(line[i > 0 ? i - 1 : 0]);
      const Vec3 after = at(line[std::min(i + 1, line.size() - 1)]) - at(line[i]);
      const Vec3 along = unit(unit(before) + unit(after));
      side -= along.dot(side) * along;
      Vec3 up;
      if (side.norm() > 0.1)
        side.normalize();
      else
        tangent_frame(along, side, up);
      up = along.cross(side);
      add_ring(at(line[i]), side, up, i > 0);
    }
  }
  void draw(const Vec3f& colour, RenderScene& out) {
    constexpr float rope_roughness = 0.8f;
    if (!indices_.empty())
      add_instance(make_mesh(std::move(positions_), std::move(normals_), std::move(indices_)),
                   nearby_, colour, rope_roughness, out);
  }

 private:
  static constexpr uint32_t sides = 8;

  static Vec3 unit(const Vec3& v) {
    const double length = v.norm();
    return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
  }
  Vec3 at(uint32_t node) const { return nodes_[node] - nearby_.origin; }
  void add_ring(const Vec3& centre, const Vec3& side, const Vec3& up, bool joined) {
    const auto first = uint32_t(positions_.size());
    for (uint32_t k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      const Vec3 n = std::cos(angle) * side + std::sin(angle) * up;
      positions_.push_back((centre + radius_ * n).cast<float>());
      normals_.push_back(n.cast<float>());
      if (!joined) continue;
      const uint32_t p = first + k, q = first + (k + 1) % sides;
      indices_.insert(indices_.end(), {p - sides, q - sides, q, p - sides, q, p});
    }
  }

  const std::vector<Vec3>& nodes_;
  Nearby nearby_;
  double radius_;
  std::vector<Vec3f> positions_, normals_;
  std::vector<uint32_t> indices_;
};

void add_strands(const SpringMesh& mesh, const std::vector<Vec3>& nodes, RenderScene& out) {
  Tubes tubes(nodes, mesh.drawing.radius);
  std::vector<uint32_t> line;
  const auto end_line = [&] {
    if (line.size() > 1) tubes.add(line);
    line.clear();
  };
  for (const SpringMesh::Strand& strand : mesh.strands) {
    const bool whole = nodes[strand.a].allFinite() && nodes[strand.b].allFinite();
    if (!whole || line.empty() || line.back() != strand.a) end_line();
    if (!whole) continue;
    if (line.empty()) line.push_back(strand.a);
    line.push_back(strand.b);
  }
  end_line();
  tubes.draw(mesh.drawing.colour, out);
}

}  // namespace

WovenParticles::WovenParticles(const Frame& frame) {
  for (const ForceFrame& force : frame.forces) {
    const SpringMesh* mesh = drawn_mesh(force);
    if (!mesh) continue;
    for (const Anchor& node : mesh->nodes)
      if (node.kind == Anchor::Kind::particle)
        by_system_[node.particles.index].push_back(node.particle);
  }
  for (auto& [system, particles] : by_system_) std::ranges::sort(particles);
}

bool WovenParticles::holds(ParticleSystemId system, uint64_t particle) const {
  const auto found = by_system_.find(system.index);
  return found != by_system_.end() && std::ranges::binary_search(found->second, particle);
}

void add_weaves(const Frame& from, const Frame& to, double s, RenderScene& out) {
  for (const ForceFrame& force : to.forces) {
    const SpringMesh* mesh = drawn_mesh(force);
    if (!mesh) continue;
    const std::vector<Vec3> nodes = nodes_between(from, force, s);
    if (!mesh->faces.empty()) add_surface(*mesh, nodes, out);
    if (!mesh->strands.empty() && mesh->drawing.radius > 0) add_strands(*mesh, nodes, out);
  }
}

}  // namespace tumble
