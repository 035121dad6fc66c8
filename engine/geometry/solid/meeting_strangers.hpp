#pragma once
#include "engine/geometry/hierarchy/triangle_decisions.hpp"

#include <vector>

namespace tumble {

/// Pairs of triangles of one mesh that have a point in common but no vertex number, each once. The
/// triangles of a large fan are looked for by a tree of their own: one box tree over long slivers
/// of two fans, say of a cone and its base, would have to look at every pair.
std::vector<TriangleIds> meeting_strangers(const TriangleMesh& mesh);

}  // namespace tumble
