#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <memory>
#include <vector>

namespace tumble {

/// What a wrap must keep inside it: a mesh that no triangle of the wrap may come nearer to than the
/// clearance. A part of the mesh that is connected and that the wrap does not cross is inside with
/// all of it or with nothing, so one point of each part, its witness, tells.
class EnclosedMesh {
 public:
  /// `clearance` [m], greater than 0. The mesh must outlive it.
  EnclosedMesh(const Hierarchy& mesh, double clearance);

  const Hierarchy& mesh() const { return mesh_; }
  /// A triangle is at least the clearance from all of the mesh.
  bool clear_of(const TriangleCorners& t) const;
  /// One point of each connected part.
  const std::vector<Vec3>& witnesses() const { return witnesses_->vertices; }
  /// The numbers of those in a box.
  void witnesses_in(const Aabb& box, std::vector<uint32_t>& out) const;

 private:
  const Hierarchy& mesh_;
  double clearance_;
  std::shared_ptr<const TriangleMesh> witnesses_;  ///< a triangle without area for each
  std::unique_ptr<Hierarchy> witness_tree_;
};

/// A point of every part of a mesh that is connected over common vertices.
std::vector<Vec3> one_point_of_each_part(const TriangleMesh& mesh);

}  // namespace tumble
