#pragma once
#include "engine/core/parameters.hpp"
#include "engine/dynamics/forces/force_context.hpp"

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Many springs between the same nodes: a cloth, a rope, a net (`weave.hpp` makes them). Nodes are
/// particles, points of bodies or of the world; what no longer exists takes its springs with it.
struct SpringMesh {
  /// A damped spring between two nodes: F = -(k (l - l0) + c dl/dt) along the line.
  struct Link {
    uint32_t a = 0, b = 0;   ///< of `nodes`
    double rest_length = 0;  ///< [m]
    double stiffness = 0;    ///< k [N/m]
    double damping = 0;      ///< c [N s/m]
  };
  /// Resistance to bending: the energy 1/2 k |q|^2 with q = sum_i w_i x_i, of weights that add up
  /// to nothing, and a damper of |q|. It is quadratic in the positions, so its stiffness is the
  /// same whatever the shape (M. Bergou et al., "A quadratic bending model for inextensible
  /// surfaces", 2006); it pulls with no total force and no total moment.
  struct Bend {
    std::array<uint32_t, 4> node{};  ///< of `nodes`; the first `count` count
    std::array<double, 4> weight{};  ///< w [-]
    uint32_t count = 0;
    double stiffness = 0;  ///< k [N/m]
    double damping =
        0;  ///< c, of the rate at which |q| changes: it does not resist turning [N s/m]
  };
  /// A triangle of its surface, to draw.
  struct Face {
    std::array<uint32_t, 3> node{};
    uint32_t tone = 0;  ///< 0 or 1: which of its two colours
  };
  /// A piece of a strand, to draw.
  struct Strand {
    uint32_t a = 0, b = 0;
  };
  /// How it is drawn.
  struct Drawing {
    Vec3f colour{0.8f, 0.8f, 0.8f}, second_colour{0.8f, 0.8f, 0.8f};  ///< linear
    double radius = 0;                                                ///< of strands [m]
  };

  std::vector<Anchor> nodes;
  std::vector<Link> links;
  std::vector<Bend> bends;
  std::vector<Face> faces;
  std::vector<Strand> strands;
  Drawing drawing;
};

/// The springs of a mesh as one force. They are solved at once, together with whatever springs hang
/// on the same nodes (SpringNet).
struct SpringMeshDef {
  static constexpr std::string_view type_name = "spring_mesh";
  std::shared_ptr<const SpringMesh> mesh;  ///< shared with frames; breaking makes another
  double break_strain = 0;                 ///< links stretched by this share break; 0: none do [-]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.break_strain, {.name = "break_strain",
                             .min = 0,
                             .doc = "springs that are stretched by this share break; 0: none"});
  }
  /// What is wrong with the mesh; empty if nothing is.
  std::string fault() const;
};

/// Where the nodes of a mesh are; nodes that are gone are not `there`.
struct MeshNode {
  bool there = false;
  Vec3 x = Vec3::Zero(), v = Vec3::Zero();  ///< [m], [m/s]
};
void locate(const SpringMesh& mesh, const ForceContext& context, std::vector<MeshNode>& out);

void apply(const SpringMeshDef& def, ForceContext& context);
double potential_energy(const SpringMeshDef& def, const ForceContext& context);

/// The unit vector along q; zero where it has no direction.
inline Vec3 direction_of(const Vec3& q) {
  const double length = q.norm();
  return length > 0 ? Vec3(q / length) : Vec3(Vec3::Zero());
}

/// Calls visit(node, force on it, the part of it that damping adds) for every end of every link and
/// every node of every bend, as they are at this moment.
template <class Visit>
void for_pulls(const SpringMesh& mesh, const std::vector<MeshNode>& nodes, const Visit& visit) {
  for (const SpringMesh::Link& link : mesh.links) {
    const MeshNode &a = nodes[link.a], &b = nodes[link.b];
    if (!a.there || !b.there) continue;
    const Vec3 d = b.x - a.x;
    const double length = d.norm();
    if (!(length > 0)) continue;  // the direction is undefined
    const Vec3 n = d / length;
    const Vec3 damped = (link.damping * n.dot(b.v - a.v)) * n;
    const Vec3 pull = (link.stiffness * (length - link.rest_length)) * n + damped;
    visit(link.a, pull, damped);
    visit(link.b, Vec3(-pull), Vec3(-damped));
  }
  for (const SpringMesh::Bend& bend : mesh.bends) {
    Vec3 q = Vec3::Zero(), rate = Vec3::Zero();
    bool whole = true;
    for (uint32_t i = 0; i < bend.count; ++i) {
      const MeshNode& node = nodes[bend.node[i]];
      whole = whole && node.there;
      q += bend.weight[i] * node.x;
      rate += bend.weight[i] * node.v;
    }
    if (!whole) continue;
    const Vec3 n = direction_of(q);
    const Vec3 damped = (bend.damping * n.dot(rate)) * n, pull = bend.stiffness * q + damped;
    for (uint32_t i = 0; i < bend.count; ++i)
      visit(bend.node[i], Vec3(-bend.weight[i] * pull), Vec3(-bend.weight[i] * damped));
  }
}

}  // namespace tumble
