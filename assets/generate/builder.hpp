#pragma once
#include "assets/generate/mesh.hpp"

#include <cstdint>
#include <map>

namespace tumble::assets {

/// Collects faces given by points. Points are rounded to micrometres and equal ones are one vertex,
/// at the first of them where the mesh is exact. So faces that share corners are connected without
/// any bookkeeping; a triangle that has lost a corner by it (at the pole of a surface of
/// revolution) disappears.
class Builder {
 public:
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c);
  /// Counter-clockwise from outside; split along the shorter diagonal.
  void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
  /// Planar polygon, counter-clockwise from outside, with holes in either direction.
  void polygon(const Loop3& outer, const std::vector<Loop3>& holes = {});

  /// The mesh with its points as they were given.
  Mesh exact_mesh() const { return {points_, triangles_}; }
  /// The mesh, moved by `offset` [m].
  Mesh mesh(const Vec3& offset = Vec3::Zero()) const;
  /// The mesh with its bounding box centred on the origin.
  Mesh centred_mesh() const;

 private:
  using Key = std::array<std::int64_t, 3>;  // [um]
  int vertex(const Vec3& point);

  std::map<Key, int> index_of_;
  std::vector<Key> vertices_;
  std::vector<Vec3> points_;  ///< the same before rounding
  std::vector<std::array<int, 3>> triangles_;
};

}  // namespace tumble::assets
