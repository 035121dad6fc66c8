// The tree of bounds. Reference: every box one by one, by intervals of the moving box's sides and
// by clamped distances. Visits may be too many, never too few; where the boxes are apart by more
// than rounding they must not be visited.
#include "engine/collision/bounds_tree.hpp"

#include "tests/collision/support.hpp"

#include <algorithm>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// Whether the moving box meets b, with b widened by `slack`.
bool meets(const Aabb& b, const Ray& ray, const Vec3& half, double t_max, double slack) {
  double in = 0, out = t_max;
  for (int k = 0; k < 3; ++k) {
    const double lo = b.min[k] - half[k] - slack, hi = b.max[k] + half[k] + slack;
    if (ray.direction[k] == 0) {
      if (ray.origin[k] < lo || ray.origin[k] > hi) return false;
      continue;
    }
    const double s = (lo - ray.origin[k]) / ray.direction[k];
    const double t = (hi - ray.origin[k]) / ray.direction[k];
    in = std::max(in, std::min(s, t));
    out = std::min(out, std::max(s, t));
  }
  return in <= out;
}

std::vector<Aabb> random_boxes(Random& r, int n, double side, const Vec3& middle) {
  std::vector<Aabb> boxes;
  for (int i = 0; i < n; ++i) {
    const Vec3 c = middle + random_vec(r, -side, side), h = random_vec(r, 0, 0.1 * side);
    boxes.push_back({c - h, c + h});
  }
  boxes.push_back({Vec3::Constant(-endless), Vec3(endless, 0, endless)});
  boxes.push_back({});
  boxes.push_back({middle, middle});
  return boxes;
}

/// Every index that must be visited is, and none that must not; returns how many were.
size_t check_visits(std::vector<uint32_t> visited, size_t n, const auto& must, const auto& may) {
  std::sort(visited.begin(), visited.end());
  CHECK(std::adjacent_find(visited.begin(), visited.end()) == visited.end());
  for (uint32_t i = 0; i < n; ++i) {
    const bool was = std::binary_search(visited.begin(), visited.end(), i);
    if (must(i)) CHECK(was);
    if (!may(i)) CHECK_FALSE(was);
  }
  return visited.size();
}

}  // namespace

TEST_CASE("a tree of bounds visits what is met, from anywhere, along any axis") {
  Random r(3);
  for (const Vec3& middle : {Vec3(0, 0, 0), Vec3(1e4, 0, -1e4), Vec3(0, 1e8, 0)}) {
    const auto boxes = random_boxes(r, cases(300), 10, middle);
    const BoundsTree tree(boxes);
    const double slack = 1e-11 * (10 + middle.norm());
    size_t met = 0;
    for (int i = 0; i < cases(200); ++i) {
      Ray ray{middle + random_vec(r, -15, 15), random_vec(r, -1, 1)};
      for (int k = 0; k < 3; ++k)
        if (r.below(4) == 0) ray.direction[k] = r.below(2) == 0 ? 0.0 : -0.0;
      const Aabb& some = boxes[r.below(uint32_t(boxes.size() - 3))];
      if (i % 3 == 0) ray.origin[int(r.below(3))] = some.min[int(r.below(3))];
      const Vec3 half = i % 2 == 0 ? Vec3(0, 0, 0) : random_vec(r, 0, 2);
      const double t_max = i % 5 == 0 ? endless : r.uniform(0, 20);
      std::vector<uint32_t> visited;
      tree.along(ray, half, t_max, [&](uint32_t k) {
        visited.push_back(k);
        return t_max;
      });
      const auto beside = [&](uint32_t k) {
        return !boxes[k].min.allFinite() && !boxes[k].empty();
      };
      met += check_visits(
          visited, boxes.size(),
          [&](uint32_t k) { return !boxes[k].empty() && meets(boxes[k], ray, half, t_max, 0); },
          [&](uint32_t k) { return beside(k) || meets(boxes[k], ray, half, t_max, slack); });

      const Aabb box{ray.origin - half, ray.origin + half};
      visited.clear();
      tree.overlapping(box, [&](uint32_t k) {
        visited.push_back(k);
        return true;
      });
      const auto overlaps = [&](uint32_t k) { return boxes[k].overlaps(box); };
      check_visits(visited, boxes.size(), overlaps,
                   [&](uint32_t k) { return beside(k) || overlaps(k); });

      const double reach = r.uniform(0, 8);
      visited.clear();
      tree.around(ray.origin, reach, [&](uint32_t k) {
        visited.push_back(k);
        return reach;
      });
      const auto distance = [&](uint32_t k) {
        const Vec3 p = ray.origin.cwiseMax(boxes[k].min).cwiseMin(boxes[k].max);
        return boxes[k].empty() ? endless : (p - ray.origin).norm();
      };
      check_visits(
          visited, boxes.size(), [&](uint32_t k) { return distance(k) <= reach; },
          [&](uint32_t k) { return beside(k) || distance(k) <= reach + slack; });
    }
    CHECK(met > 0);
  }
}

TEST_CASE("a tree of bounds with everything in one place, and with nothing") {
  const std::vector<Aabb> same(1000, Aabb{Vec3(1, 1, 1), Vec3(2, 2, 2)});
  size_t visits = 0;
  BoundsTree(same).along({{0, 1.5, 1.5}, {1, 0, 0}}, Vec3::Zero(), endless, [&](uint32_t) {
    ++visits;
    return endless;
  });
  CHECK(visits == 1000);
  const auto never = [](uint32_t) {
    FAIL_CHECK("visited");
    return 1.0;
  };
  BoundsTree().around({0, 0, 0}, endless, never);
  BoundsTree(std::vector<Aabb>(3)).along({{0, 0, 0}, {1, 0, 0}}, Vec3::Zero(), 1, never);
  // A shrinking limit leaves out what is behind; a negative one ends the search.
  std::vector<Aabb> row;
  for (int i = 0; i < 500; ++i) row.push_back({Vec3(i, 0, 0), Vec3(i + 0.5, 1, 1)});
  visits = 0;
  BoundsTree(row).along({{-1, 0.5, 0.5}, {1, 0, 0}}, Vec3::Zero(), endless, [&](uint32_t i) {
    ++visits;
    return double(i) + 1;
  });
  CHECK(visits < 30);
  visits = 0;
  BoundsTree(row).around({0, 0, 0}, endless, [&](uint32_t) {
    ++visits;
    return -1.0;
  });
  CHECK(visits == 1);
}
