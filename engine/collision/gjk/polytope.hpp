#pragma once
#include "engine/collision/gjk/minkowski.hpp"

namespace tumble {

/// The convex hull of points of a difference, extended by one point at a time: faces are triangles,
/// and those that see a new point are replaced by a fan from it. Whether a face sees a point is
/// decided in double precision with a bound on its error, and in double-double arithmetic if that
/// is inconclusive, so that the hull stays convex and closed for needles, plates and parallel faces
/// alike. Points in the plane of a face count as seen. Stored on the stack, without allocations.
class Polytope {
 public:
  static constexpr int max_vertices = 256;

  /// Side k runs from corner k to corner k + 1; the face beyond it is next[k], where it is side
  /// next_side[k].
  struct Face {
    std::array<int, 3> corner, next, next_side;
    Plain3 normal;  ///< unit, outward
    double tilt;    ///< bound on the error of `normal`
    bool alive;
  };

  /// Starts with the hull of four points; false if they are coplanar.
  bool start(const std::array<DifferencePoint, 4>& points);
  /// Adds a point outside of face `seen`. False if there is no room, or if rounding left a horizon
  /// that is not a simple loop; the hull is then unusable.
  bool add(const DifferencePoint& p, int seen);

  /// The face whose plane is nearest to the origin.
  int nearest_face() const;
  /// Face indices are below this; some of the faces are dead.
  int face_slots() const { return face_count_; }
  const Face& face(int f) const { return faces_[size_t(f)]; }
  /// Distance of a face's plane from the origin; infinite for dead faces.
  double offset(int f) const { return offset_[size_t(f)]; }
  const DifferencePoint& vertex(int v) const { return vertices_[size_t(v)]; }
  int vertex_count() const { return vertex_count_; }

 private:
  /// For the faces of the hull, and those that are removed while a point is added.
  static constexpr int max_faces = 4 * max_vertices;
  int add_face(int i, int j, int k);
  void link(int f, int side, int g, int other_side);
  bool sees(const Face& f, const Plain3& p) const;
  void kill(int f);
  bool grow(int f, int side, int vertex);

  std::array<DifferencePoint, max_vertices> vertices_;
  std::array<Face, max_faces> faces_;
  alignas(16) std::array<double, max_faces + 1> offset_;
  std::array<int, max_faces> free_, dying_;
  int vertex_count_ = 0, face_count_ = 0, free_count_ = 0, dying_count_ = 0;
  int first_new_ = -1, last_new_ = -1;  ///< faces of the fan being built
};

}  // namespace tumble
