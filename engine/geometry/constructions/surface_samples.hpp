#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <vector>

namespace tumble {

/// Points of a mesh's surface, evenly by area, the same on every machine: a low-discrepancy
/// sequence (Halton 1960).
class SurfaceSamples {
 public:
  explicit SurfaceSamples(const TriangleMesh& mesh);

  struct Sample {
    Vec3 point;
    uint32_t triangle;
  };
  /// Number n >= 1; the mesh has area.
  Sample operator()(size_t n) const;

 private:
  const TriangleMesh& mesh_;
  std::vector<double> area_before_;
};

/// Points of the inside of a convex mesh, evenly by volume; those of the cones over its triangles
/// about the mean of its vertices.
class InsideSamples {
 public:
  explicit InsideSamples(const TriangleMesh& convex);
  Vec3 operator()(size_t n) const;

 private:
  const TriangleMesh& mesh_;
  Vec3 apex_ = Vec3::Zero();
  std::vector<double> volume_before_;
};

}  // namespace tumble
