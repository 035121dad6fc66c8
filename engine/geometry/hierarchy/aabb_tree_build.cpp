#include "engine/geometry/hierarchy/aabb_tree_build.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr int bins = 16;
/// From this depth on nodes are halved, which ends within 32 levels.
constexpr int forced_median_depth = 60;

float round_down(double x) {
  const auto f = float(x);
  return double(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float round_up(double x) {
  const auto f = float(x);
  return double(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

double half_area(const Aabb& b) {
  const Vec3 e = b.extent();
  return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
}

struct Builder {
  std::vector<Aabb> boxes;  // of the triangles, relative to the origin
  std::vector<Vec3> centres;
  AabbTreeParts out;

  struct Split {
    int axis = -1;
    int bin = 0;
    double cost = std::numeric_limits<double>::infinity();
  };

  int bin_of(uint32_t t, int axis, double low, double inverse_width) const {
    const int b = int((centres[t][axis] - low) * inverse_width);
    return std::clamp(b, 0, bins - 1);
  }

  Split best_split(uint32_t begin, uint32_t end, const Aabb& centre_box) const {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = centre_box.min[axis], width = centre_box.max[axis] - low;
      if (!(width > 0)) continue;
      const double inverse = bins / width;
      if (!std::isfinite(inverse)) continue;
      Aabb box[bins];
      uint32_t count[bins] = {};
      for (uint32_t i = begin; i < end; ++i) {
        const uint32_t t = out.order[i];
        const int b = bin_of(t, axis, low, inverse);
        box[b].include(boxes[t]);
        ++count[b];
      }
      double right_cost[bins] = {};
      Aabb right;
      uint32_t right_count = 0;
      for (int b = bins - 1; b > 0; --b) {
        if (count[b] > 0) right.include(box[b]);
        right_count += count[b];
        right_cost[b] = right_count > 0 ? half_area(right) * right_count : -1;
      }
      Aabb left;
      uint32_t left_count = 0;
      for (int b = 0; b + 1 < bins; ++b) {
        if (count[b] > 0) left.include(box[b]);
        left_count += count[b];
        if (left_count == 0 || right_cost[b + 1] < 0) continue;
        const double cost = half_area(left) * left_count + right_cost[b + 1];
        if (cost < best.cost) best = {axis, b + 1, cost};
      }
    }
    return best;
  }

  uint32_t partition(uint32_t begin, uint32_t end, const Aabb& centre_box, int depth) {
    auto first = out.order.begin() + begin, last = out.order.begin() + end;
    if (depth < forced_median_depth) {
      const Split s = best_split(begin, end, centre_box);
      if (s.axis >= 0) {
        const double low = centre_box.min[s.axis];
        const double inverse = bins / (centre_box.max[s.axis] - low);
        const auto middle = std::stable_partition(
            first, last, [&](uint32_t t) { return bin_of(t, s.axis, low, inverse) < s.bin; });
        return uint32_t(middle - out.order.begin());
      }
    }
    int axis = 0;
    centre_box.extent().maxCoeff(&axis);
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(first, out.order.begin() + middle, last, [&](uint32_t a, uint32_t b) {
      return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b;
    });
    return middle;
  }

  void store(uint32_t node, const Aabb& box) {
    for (int k = 0; k < 3; ++k) {
      out.nodes[node].min[size_t(k)] = round_down(box.min[k]);
      out.nodes[node].max[size_t(k)] = round_up(box.max[k]);
    }
  }

  void build() {
    struct Task {
      uint32_t begin, end, parent;  // parent: whose second child this is, or no_index
      int depth;
    };
    std::vector<Task> tasks{{0, uint32_t(boxes.size()), no_index, 0}};
    while (!tasks.empty()) {
      const Task task = tasks.back();
      tasks.pop_back();
      const auto node = uint32_t(out.nodes.size());
      out.nodes.emplace_back();
      out.depth = std::max(out.depth, task.depth);
      if (task.parent != no_index) out.nodes[task.parent].start = node;
      Aabb box, centre_box;
      for (uint32_t i = task.begin; i < task.end; ++i) {
        box.include(boxes[out.order[i]]);
        centre_box.include(centres[out.order[i]]);
      }
      store(node, box);
      const uint32_t count = task.end - task.begin;
      if (count <= AabbTree::max_leaf_triangles) {
        out.nodes[node].start = task.begin;
        out.nodes[node].count = count;
        std::sort(out.order.begin() + task.begin, out.order.begin() + task.end);
        continue;
      }
      out.nodes[node].count = 0;
      const uint32_t middle = partition(task.begin, task.end, centre_box, task.depth);
      tasks.push_back({middle, task.end, node, task.depth + 1});
      tasks.push_back({task.begin, middle, no_index, task.depth + 1});
    }
  }
};

}  // namespace

AabbTreeParts build_aabb_tree(const TriangleMesh& mesh, const Vec3& origin) {
  Builder b;
  const size_t n = mesh.triangles.size();
  b.boxes.reserve(n);
  b.centres.reserve(n);
  b.out.order.reserve(n);
  b.out.nodes.reserve(n);
  for (size_t t = 0; t < n; ++t) {
    Aabb box = triangle_bounds(mesh, t);
    box.min -= origin;
    box.max -= origin;
    b.boxes.push_back(box);
    b.centres.push_back(box.centre());
    b.out.order.push_back(uint32_t(t));
  }
  if (n > 0) b.build();
  b.out.nodes.shrink_to_fit();
  return std::move(b.out);
}

}  // namespace tumble
