#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/triangle_mesh.hpp"
#include "viewer/capture/particles/particle_sample.hpp"

namespace tumble {

/// Particles as the vertices of a PLY file (Turk, "The PLY polygon file format", 1994), binary and
/// little-endian: double x y z [m], vx vy vz [m/s], radius [m], mass [kg], age [s], uint id, and
/// uchar red green blue (sRGB). Values are bitwise those of the world, except colours. Fails if an
/// id exceeds 32 bits, since the format has no larger integer. `time` [s] becomes a comment.
Result<std::string> ply_of(const ParticleSample& particles, double time);

/// A mesh as binary PLY: double x y z [m], and faces as lists of int vertex_indices.
std::string ply_of(const TriangleMesh& mesh, double time);

}  // namespace tumble
