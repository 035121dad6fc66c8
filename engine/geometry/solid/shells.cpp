#include "engine/geometry/solid/shells.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"
#include "engine/geometry/primitive_tests/triangle_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

namespace tumble {
namespace {

/// Winding numbers by shell; only those that are not 0, ascending.
using Windings = std::map<uint32_t, int>;

/// Winding numbers of all closed shells except the point's own.
class ShellWindings {
 public:
  ShellWindings(const TriangleMesh& mesh, const std::vector<uint32_t>& part,
                const std::vector<SolidShell>& shells)
      : part_(part),
        shells_(shells),
        tree_(std::make_shared<const TriangleMesh>(mesh)),
        off_(1e-9 * tree_.bounds().extent().maxCoeff()) {}

  /// Empty if p lies on another shell than `own` or, for a rounded point, near one.
  std::optional<Windings> at(const Vec3& p, uint32_t own, bool rounded) {
    if (rounded) {
      found_.clear();
      tree_.overlap(Aabb{p, p}.inflated(off_), found_);
      for (uint32_t t : found_) {
        if (part_[t] != own) return std::nullopt;
      }
    }
    found_.clear();
    Aabb ray{p, p};
    ray.max.x() = tree_.bounds().max.x();
    tree_.overlap(ray, found_);
    Windings out;
    for (uint32_t t : found_) {
      if (part_[t] == own || !shells_[part_[t]].closed) continue;
      const Triangle3 corners_of_t = corners(tree_.mesh(), t);
      if (triangle_bounds(tree_.mesh(), t).contains(p) && point_in_triangle(p, corners_of_t)) {
        return std::nullopt;
      }
      out[part_[t]] += ray_crossing(p, corners_of_t);
    }
    std::erase_if(out, [](const auto& entry) { return entry.second == 0; });
    return out;
  }

  /// Passes corners, midpoints of sides and the centroid of triangle t to `take` until it returns
  /// true.
  template <class Take>
  void samples(uint32_t t, bool midpoints, const Take& take) const {
    const Triangle3 c = corners(tree_.mesh(), t);
    for (const Vec3& p : c) {
      if (take(p, false)) return;
    }
    if (!midpoints) return;
    for (size_t k = 0; k < 3; ++k) {
      if (take(0.5 * (c[k] + c[(k + 1) % 3]), true)) return;
    }
    take((c[0] + c[1] + c[2]) / 3, true);
  }

 private:
  const std::vector<uint32_t>& part_;
  const std::vector<SolidShell>& shells_;
  AabbTree tree_;
  double off_;
  std::vector<uint32_t> found_;
};

int winding_in(const Windings& w, uint32_t shell) {
  const auto found = w.find(shell);
  return found == w.end() ? 0 : found->second;
}

}  // namespace

std::vector<SolidShell> measure_shells(const TriangleMesh& mesh, const MeshTopology& topology,
                                       const std::vector<uint32_t>& part, size_t count) {
  std::vector<SolidShell> shells(count);
  std::vector<Vec3> origin(count, Vec3::Zero());
  for (SolidShell& s : shells) s.closed = true;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    SolidShell& s = shells[part[t]];
    if (s.triangles++ == 0) {
      s.first_triangle = t;
      origin[part[t]] = mesh.corner(t, 0);
    }
    const Vec3& o = origin[part[t]];
    const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    s.volume += (a - o).dot((b - a).cross(c - a)) / 6;
  }
  for (const MeshEdge& e : topology.edges) {
    const bool paired = e.face_count == 2 && e.bend != EdgeBend::open;
    if (!paired) shells[part[e.faces[0]]].closed = false;
  }
  for (SolidShell& s : shells) {
    if (!s.closed) s.volume = 0;
  }
  return shells;
}

ShellNesting nest_shells(const TriangleMesh& mesh, const std::vector<uint32_t>& part,
                         const std::vector<SolidShell>& shells, const std::vector<uint8_t>& crossed,
                         const std::vector<TriangleIds>& touching) {
  ShellNesting out;
  out.winding.assign(shells.size(), 0);
  out.depth.assign(shells.size(), 0);
  if (shells.size() < 2) return out;
  ShellWindings windings(mesh, part, shells);

  // Winding numbers at the first point of each shell that is on no other shell. Without contacts
  // any corner will do.
  std::vector<uint8_t> known(shells.size(), 0);
  std::vector<Windings> around(shells.size());
  for (const bool midpoints : {false, true}) {
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const uint32_t s = part[t];
      if (known[s] || crossed[s] || !shells[s].closed) continue;
      windings.samples(t, midpoints, [&](const Vec3& p, bool rounded) {
        const auto w = windings.at(p, s, rounded);
        if (w) around[s] = *w;
        known[s] = w.has_value();
        return w.has_value();
      });
    }
  }
  for (size_t s = 0; s < shells.size(); ++s) {
    for (const auto& [other, winding] : around[s]) out.winding[s] += winding;
    out.depth[s] = uint32_t(around[s].size());
  }

  // Shells that touch without crossing have no corner on the other side of each other.
  for (const TriangleIds& ids : touching) {
    bool crossing = false;
    for (const auto& [t, u] : {std::pair(ids.a, ids.b), std::pair(ids.b, ids.a)}) {
      const uint32_t s = part[t], other = part[u];
      if (!shells[s].closed || !shells[other].closed || !known[s]) continue;
      windings.samples(t, true, [&](const Vec3& p, bool rounded) {
        const auto w = windings.at(p, s, rounded);
        crossing = crossing || (w && winding_in(*w, other) != winding_in(around[s], other));
        return crossing;
      });
    }
    if (crossing) out.crossings.push_back(ids);
  }
  return out;
}

}  // namespace tumble
