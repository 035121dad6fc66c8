#include "engine/geometry/solid/vertex_fans.hpp"

#include <algorithm>
#include <numeric>

namespace tumble {
namespace {

uint32_t fan_leader(std::vector<uint32_t>& leader, uint32_t i) {
  while (leader[i] != i) i = leader[i] = leader[leader[i]];
  return i;
}

}  // namespace

std::vector<uint32_t> non_manifold_vertices(const TriangleMesh& mesh,
                                            const MeshTopology& topology) {
  std::vector<uint32_t> out;
  std::vector<std::pair<uint32_t, uint32_t>> spokes;  // edge at the vertex, index of a face there
  std::vector<uint32_t> leader;
  for (uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto faces = topology.faces_of_vertex(v);
    if (faces.size() < 2) continue;
    spokes.clear();
    leader.resize(faces.size());
    std::iota(leader.begin(), leader.end(), 0u);
    for (uint32_t i = 0; i < faces.size(); ++i) {
      for (uint32_t e : topology.face_edges[faces[i]]) {
        if (e == no_index) continue;
        const auto& ends = topology.edges[e].vertices;
        if (ends[0] == v || ends[1] == v) spokes.emplace_back(e, i);
      }
    }
    std::sort(spokes.begin(), spokes.end());
    size_t fans = faces.size();
    for (size_t i = 1; i < spokes.size(); ++i) {
      if (spokes[i].first != spokes[i - 1].first) continue;
      const uint32_t a = fan_leader(leader, spokes[i].second),
                     b = fan_leader(leader, spokes[i - 1].second);
      if (a == b) continue;
      leader[std::max(a, b)] = std::min(a, b);
      --fans;
    }
    if (fans > 1) out.push_back(v);
  }
  return out;
}

}  // namespace tumble
