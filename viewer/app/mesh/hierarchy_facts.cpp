#include "viewer/app/mesh/hierarchy_facts.hpp"

#include "engine/core/watched.hpp"
#include "viewer/render/overlays.hpp"

#include <algorithm>
#include <chrono>

namespace tumble {

std::vector<HierarchyFacts> hierarchy_facts(const std::shared_ptr<const TriangleMesh>& mesh,
                                            double hull_volume, double area, double done_before) {
  std::vector<HierarchyFacts> all;
  for (const HierarchyKind& kind : all_hierarchies()) {
    const auto& drawn = drawn_hierarchies();
    if (std::find(drawn.begin(), drawn.end(), kind.name) == drawn.end()) continue;
    const auto start = std::chrono::steady_clock::now();
    const auto tree = kind.build(mesh);
    const std::chrono::duration<double, std::milli> spent =
        std::chrono::steady_clock::now() - start;
    const HierarchyRoom room = measure_room(*tree);
    HierarchyFacts f;
    f.kind = kind.name;
    f.nodes = room.nodes;
    f.leaves = room.leaves;
    f.depth = tree->depth();
    f.bytes = tree->state_bytes();
    f.bytes_per_triangle = double(f.bytes) / double(mesh->triangles.size());
    f.build_ms = spent.count();
    if (hull_volume > 0) f.root_over_hull = room.root_volume / hull_volume;
    if (area > 0) f.leaves_over_mesh = room.leaf_surface / area;
    f.nodes_per_line = room.nodes_per_line;
    all.push_back(f);
    tell_progress(done_before +
                  (1 - done_before) * double(all.size()) / double(drawn_hierarchies().size()));
  }
  return all;
}

}  // namespace tumble
