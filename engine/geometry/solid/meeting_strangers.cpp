#include "engine/geometry/solid/meeting_strangers.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/hull_tree.hpp"

#include <algorithm>
#include <map>
#include <memory>

namespace tumble {
namespace {

/// Fans with more triangles than this get a tree of their own.
constexpr uint32_t own_tree_fan = 256;

/// Some triangles of a mesh with a tree of hulls, which separates wedges that only meet in their
/// tips.
class Group {
 public:
  Group(const TriangleMesh& mesh, std::vector<uint32_t> triangles) : ids_(std::move(triangles)) {
    auto part = std::make_shared<TriangleMesh>();
    std::vector<uint32_t> used;
    for (const uint32_t t : ids_) {
      for (const uint32_t v : mesh.triangles[t]) used.push_back(v);
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (const uint32_t v : used) part->vertices.push_back(mesh.vertices[v]);
    for (const uint32_t t : ids_) {
      Triangle& own = part->triangles.emplace_back();
      for (size_t k = 0; k < 3; ++k) {
        const auto at = std::lower_bound(used.begin(), used.end(), mesh.triangles[t][k]);
        own[k] = uint32_t(at - used.begin());
      }
    }
    tree_ = std::make_unique<HullTree>(std::move(part));
  }

  void own_pairs(std::vector<TriangleIds>& out) const {
    std::vector<TriangleIds> found;
    tree_->self_pairs(0, found);
    for (const TriangleIds& p : found) out.push_back({ids_[p.a], ids_[p.b]});
  }

  void pairs(const Group& other, const TriangleMesh& mesh, std::vector<TriangleIds>& out) const {
    if (!tree_->bounds().overlaps(other.tree_->bounds())) return;
    std::vector<TriangleIds> found;
    tree_->pairs(*other.tree_, Pose{Vec3::Zero(), Quat::Identity()}, 0, found);
    for (const TriangleIds& p : found) {
      const uint32_t a = ids_[p.a], b = other.ids_[p.b];
      if (!neighbours(mesh, a, b)) out.push_back({std::min(a, b), std::max(a, b)});
    }
  }

 private:
  std::vector<uint32_t> ids_;  // ascending
  std::unique_ptr<HullTree> tree_;
};

/// Groups triangles by that vertex of theirs where most triangles meet, if these are many; the rest
/// form one group.
std::vector<Group> groups(const TriangleMesh& mesh, const std::vector<uint32_t>& fan) {
  std::map<uint32_t, std::vector<uint32_t>> members;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const uint32_t tip = *std::max_element(c.begin(), c.end(), [&](uint32_t a, uint32_t b) {
      return fan[a] != fan[b] ? fan[a] < fan[b] : a > b;
    });
    members[fan[tip] > own_tree_fan ? tip : no_index].push_back(t);
  }
  std::vector<Group> out;
  for (auto& [tip, triangles] : members) out.emplace_back(mesh, std::move(triangles));
  return out;
}

}  // namespace

std::vector<TriangleIds> meeting_strangers(const TriangleMesh& mesh) {
  std::vector<TriangleIds> out;
  std::vector<uint32_t> fan(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const uint32_t v : t) ++fan[v];
  }
  if (std::none_of(fan.begin(), fan.end(), [](uint32_t n) { return n > own_tree_fan; })) {
    AabbTree(std::make_shared<const TriangleMesh>(mesh)).self_pairs(0, out);
    return out;
  }
  const std::vector<Group> all = groups(mesh, fan);
  for (size_t i = 0; i < all.size(); ++i) {
    all[i].own_pairs(out);
    for (size_t j = 0; j < i; ++j) all[i].pairs(all[j], mesh, out);
  }
  return out;
}

}  // namespace tumble
