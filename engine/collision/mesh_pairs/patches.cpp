#include "engine/collision/mesh_pairs/patches.hpp"

#include "engine/collision/feature_key.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Normals closer than this share a manifold: about 10 degrees.
constexpr double same_normal = 0.985;
/// Above this number of manifolds the rest join the nearest one.
constexpr size_t max_patches = 16;
/// Cells along the side of the octahedral map of directions; odd, so that the axes are mid-cell.
constexpr double cells = 15;

struct Patch {
  Vec3 seed;
  Vec3 sum = Vec3::Zero();
  std::vector<ManifoldPoint> points;
};

void add(Patch& patch, const FeatureContact& c, double margin, double depth_scale) {
  // the same vertex against two nearly parallel triangles counts once, as the deeper one
  for (const ManifoldPoint& p : patch.points)
    if (p.feature == c.key) return;
  patch.sum += (margin - c.gap + depth_scale) * c.normal;
  patch.points.push_back({c.x, c.gap, c.key});
}

}  // namespace

uint64_t direction_cell(const Vec3& n) {
  const double sum = n.cwiseAbs().sum();
  double u = n.x() / sum, v = n.z() / sum;
  if (n.y() < 0) {
    const double folded = (1 - std::abs(v)) * (u < 0 ? -1.0 : 1.0);
    v = (1 - std::abs(u)) * (v < 0 ? -1.0 : 1.0);
    u = folded;
  }
  const auto cell = [](double x) {
    return uint64_t(std::clamp(std::floor((x + 1) * 0.5 * cells), 0.0, cells - 1));
  };
  return 1 + cell(u) * uint64_t(cells) + cell(v);
}

void emit_patches(const ShapePair& pair, std::vector<FeatureContact>& contacts,
                  std::vector<Manifold>& out) {
  if (contacts.empty()) return;
  std::sort(contacts.begin(), contacts.end(), [](const FeatureContact& a, const FeatureContact& b) {
    if (a.gap != b.gap) return a.gap < b.gap;
    if (a.key != b.key) return a.key < b.key;
    return std::lexicographical_compare(a.normal.data(), a.normal.data() + 3, b.normal.data(),
                                        b.normal.data() + 3);
  });
  const double scale = 1e-3 * (pair.margin - contacts.front().gap) + 1e-12;
  thread_local std::vector<Patch> patches;
  size_t used = 0;
  for (const FeatureContact& c : contacts) {
    size_t best = 0;
    double alignment = -2;
    for (size_t i = 0; i < used; ++i) {
      const double a = patches[i].seed.dot(c.normal);
      if (a > alignment) alignment = a, best = i;
    }
    if (alignment < same_normal) {
      if (used == max_patches) {
        if (alignment < 0.7) continue;
      } else {
        best = used++;
        if (patches.size() < used) patches.emplace_back();
        patches[best].seed = c.normal;
        patches[best].sum.setZero();
        patches[best].points.clear();
      }
    }
    add(patches[best], c, pair.margin, scale);
  }
  const size_t first = out.size();
  for (size_t i = 0; i < used; ++i) {
    const Vec3 normal = patches[i].sum.normalized();
    uint64_t part = direction_cell(normal);
    for (size_t j = first; j < out.size(); ++j)
      if (out[j].part == part) part += patches_of_cell;
    emit_nearest(pair, patches[i].points, normal, part, out);
  }
}

}  // namespace tumble
