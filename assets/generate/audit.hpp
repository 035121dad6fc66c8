#pragma once
#include "assets/generate/mesh.hpp"

#include <string>

namespace tumble::assets {

/// What is measured of a mesh before it may be written.
struct Audit {
  std::vector<std::string> faults;  ///< empty for a closed, oriented 2-manifold without slivers
  int pieces = 0;                   ///< connected components
  double volume = 0;                ///< [m^3], positive when oriented outwards
  double least_altitude = 0;        ///< of any triangle [m]
  Vec3 low = Vec3::Zero();          ///< bounds [m]
  Vec3 high = Vec3::Zero();
};

/// Every edge borders two triangles in opposite directions, the triangles around each vertex form
/// one fan, every piece encloses a positive volume, and no triangle is lower than 50 um.
Audit audit(const Mesh& mesh);

/// By the divergence theorem [m^3].
double volume(const Mesh& mesh);

}  // namespace tumble::assets
