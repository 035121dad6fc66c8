#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "engine/geometry/isosurface/sparse_field.hpp"

namespace tumble {

class Crew;

/// A function on all nodes of a box that is less than 0 inside, and of which nothing but where it
/// is 0 is wanted.
class OutsideGrid {
 public:
  /// With room for `margin` [m] about a box; errors name a spacing that would do.
  static Result<OutsideGrid> make(const Aabb& box, double margin, double spacing, size_t max_bytes);

  /// At every node the distance from a surface less `radius` [m], exactly within the longest edge
  /// of a tetrahedron from where it is 0, elsewhere with its sign alone.
  void measure(const Hierarchy& surface, double radius, Crew* crew);
  /// What cannot be reached from the first corner over edges of the tetrahedra without coming
  /// inside is made inside.
  void fill_unreached();
  /// The outside grows: inside remains what is farther than `way` [m] from all nodes outside; the
  /// values are the way less that distance. Distances between nodes are exact (Felzenszwalb and
  /// Huttenlocher, "Distance transforms of sampled functions", 2012).
  void grow_outside(double way, Crew* crew);
  /// No value is nearer to 0 than `least` [m], so that no triangles of the surface are much smaller
  /// than cells. Which nodes are inside stays.
  void keep_off_nodes(double least);
  const SparseField& field() const { return field_; }
  /// Edges of the tetrahedra with one end inside: vertices of the surface.
  size_t cut_edges() const;

 private:
  OutsideGrid() = default;
  void measure_row(const Hierarchy& surface, double radius, int y, int z);
  double& at(const std::array<int, 3>& node) {
    return field_.bricks[brick_of(node)].value[place_of(node)];
  }
  bool inside(const std::array<int, 3>& node) const {
    return field_.bricks[brick_of(node)].value[place_of(node)] < 0;
  }
  size_t brick_of(const std::array<int, 3>& node) const {
    constexpr int edge = SparseField::edge;
    return size_t((node[0] / edge * bricks_[1] + node[1] / edge) * bricks_[2] + node[2] / edge);
  }
  static size_t place_of(const std::array<int, 3>& node) {
    constexpr int edge = SparseField::edge;
    return size_t((node[2] % edge * edge + node[1] % edge) * edge + node[0] % edge);
  }
  size_t number(const std::array<int, 3>& node) const {
    return (size_t(node[2]) * size_t(nodes_[1]) + size_t(node[1])) * size_t(nodes_[0]) +
           size_t(node[0]);
  }

  SparseField field_;  ///< with all bricks of the box
  std::array<int, 3> bricks_{}, nodes_{};
};

}  // namespace tumble
