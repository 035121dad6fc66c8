#include "engine/geometry/decomposition/plane_cut.hpp"

#include "engine/geometry/decomposition/planar_graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace tumble {
namespace {

/// Lexicographic order of points.
bool before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// The mesh with every triangle that crosses the plane cut in two or three.
struct SplitMesh {
  TriangleMesh mesh;
  std::vector<uint32_t> plane;
  std::vector<TriangleSide> mates;
  std::vector<int> side;     ///< of each vertex: over the plane, on it, beneath: 1, 0, -1
  std::vector<int> belongs;  ///< of each triangle: to the solid over the plane, 1, or beneath, -1
};

class Splitter {
 public:
  Splitter(const SolidPiece& piece, const CutRequest& request)
      : piece_(piece),
        plane_(request.plane),
        middle_(piece.mates.size(), no_index),
        parts_(piece.mates.size()) {
    out_.mesh.vertices = piece.mesh.vertices;
    for (const Vec3& v : piece.mesh.vertices) {
      height_.push_back(plane_.distance(v));
      const double h = height_.back();
      out_.side.push_back(h > request.tolerance ? 1 : h < -request.tolerance ? -1 : 0);
    }
    for (const auto& edge : request.edges)
      for (const uint32_t v : edge) out_.side[v] = 0;
  }

  SplitMesh split() {
    for (now_ = 0; now_ < piece_.mesh.triangles.size(); ++now_) triangle();
    for (TriangleSide s = 0; s < parts_.size(); ++s) {
      const SideParts &own = parts_[s], &other = parts_[piece_.mates[s]];
      if (own.first != no_index) out_.mates[own.first] = other.second;
      if (own.second != no_index) out_.mates[own.second] = other.first;
    }
    return std::move(out_);
  }

 private:
  /// What a side has become: from its start to where it is cut, and from there to its end. A side
  /// that is not cut is both at once.
  struct SideParts {
    TriangleSide first = no_index, second = no_index;
  };
  static constexpr size_t after(size_t k) { return (k + 1) % 3; }

  int side(uint32_t v) const { return out_.side[v]; }

  void triangle() {
    const Triangle& v = piece_.mesh.triangles[now_];
    const auto over = std::count_if(v.begin(), v.end(), [&](uint32_t i) { return side(i) > 0; }),
               beneath = std::count_if(v.begin(), v.end(), [&](uint32_t i) { return side(i) < 0; });
    if (over == 0 || beneath == 0) {
      // On the plane: the solid is behind it.
      const bool flat = over == 0 && beneath == 0;
      const bool up = flat && face_area_vector(piece_.mesh, now_).dot(plane_.normal) > 0;
      const uint32_t t = add(v, flat ? (up ? -1 : 1) : (over > 0 ? 1 : -1));
      for (size_t k = 0; k < 3; ++k) whole(k, 3 * t + TriangleSide(k));
    } else if (over + beneath == 2) {
      size_t k = 0;  // the corner on the plane; the others are on either side of it
      while (side(v[k]) != 0) ++k;
      halve(k);
    } else {
      size_t k = 0;  // the corner alone on its side
      while (side(v[k]) != (over == 1 ? 1 : -1)) ++k;
      cut_corner(k);
    }
  }

  /// Along the line from corner k to the opposite side.
  void halve(size_t k) {
    const Triangle& v = piece_.mesh.triangles[now_];
    const size_t a = after(k), b = after(a);
    const uint32_t m = middle(a);
    const uint32_t t = add({v[k], v[a], m}, side(v[a])), u = add({v[k], m, v[b]}, side(v[b]));
    whole(k, 3 * t);
    parts(a, 3 * t + 1, 3 * u + 1);
    whole(b, 3 * u + 2);
    join(3 * t + 2, 3 * u);
  }

  /// Corner k from the rest, which is a quadrilateral: two triangles, by its shorter diagonal.
  void cut_corner(size_t k) {
    const Triangle& v = piece_.mesh.triangles[now_];
    const size_t a = after(k), b = after(a);
    const int lone = side(v[k]);
    const uint32_t m = middle(k), n = middle(b);
    const uint32_t t = add({v[k], m, n}, lone);
    const auto& at = out_.mesh.vertices;
    const bool from_a = (at[n] - at[v[a]]).squaredNorm() < (at[m] - at[v[b]]).squaredNorm();
    // m -> a -> b -> n
    const uint32_t u = add(from_a ? Triangle{m, v[a], n} : Triangle{m, v[a], v[b]}, -lone),
                   w = add(from_a ? Triangle{n, v[a], v[b]} : Triangle{m, v[b], n}, -lone);
    parts(k, 3 * t, 3 * u);
    whole(a, from_a ? 3 * w + 1 : 3 * u + 1);
    parts(b, from_a ? 3 * w + 2 : 3 * w + 1, 3 * t + 2);
    join(3 * t + 1, from_a ? 3 * u + 2 : 3 * w + 2);
    join(from_a ? 3 * u + 1 : 3 * u + 2, 3 * w);
  }

  uint32_t add(const Triangle& v, int belongs) {
    out_.mesh.triangles.push_back(v);
    out_.plane.push_back(piece_.plane[now_]);
    out_.belongs.push_back(belongs);
    out_.mates.resize(out_.mates.size() + 3, no_index);
    return uint32_t(out_.belongs.size()) - 1;
  }
  void join(TriangleSide a, TriangleSide b) {
    out_.mates[a] = b;
    out_.mates[b] = a;
  }
  void parts(size_t k, TriangleSide first, TriangleSide second) {
    parts_[3 * now_ + k] = {first, second};
  }
  void whole(size_t k, TriangleSide s) { parts(k, s, s); }

  /// Where side k of the present triangle meets the plane. Of equal edges the same point, whichever
  /// way they are run.
  uint32_t middle(size_t k) {
    const auto s = TriangleSide(3 * now_ + k);
    uint32_t& place = middle_[s];
    if (place != no_index) return place;
    const auto& at = out_.mesh.vertices;
    uint32_t a = side_start(piece_.mesh, s), b = side_end(piece_.mesh, s);
    if (before(at[b], at[a])) std::swap(a, b);
    const double t = height_[a] / (height_[a] - height_[b]);
    const Vec3 point = at[a] + t * (at[b] - at[a]);
    place = uint32_t(at.size());
    middle_[piece_.mates[s]] = place;
    out_.mesh.vertices.push_back(point);
    out_.side.push_back(0);
    return place;
  }

  const SolidPiece& piece_;
  const Plane& plane_;
  SplitMesh out_;
  std::vector<double> height_;
  std::vector<uint32_t> middle_;  ///< vertex on each side, if it is cut
  std::vector<SideParts> parts_;
  size_t now_ = 0;
};

/// The section of a split mesh with the plane, as edges between points of the plane.
class Section {
 public:
  Section(const SplitMesh& split, std::span<const TriangleSide> mates, const Vec3& normal)
      : split_(split) {
    for (TriangleSide s = 0; s < mates.size(); ++s)
      if (is_on_plane(s)) add_points(s);
    number_points(normal);
    for (TriangleSide s = 0; s < mates.size(); ++s)
      if (is_on_plane(s) && mates[s] != no_index) add_edge(s, mates[s]);
  }

  bool triangulate() {
    auto cover = triangulate_graph(points_, edges_);
    if (!cover) return false;
    cover_ = *std::move(cover);
    return true;
  }
  const PlanarCover& cover() const { return cover_; }

  /// Connected parts of the section that touch one of these edges; all of them without edges.
  std::vector<char> selected(std::span<const std::array<uint32_t, 2>> wanted) const {
    const size_t count = cover_.triangles.size();
    std::vector<char> out(count, wanted.empty());
    std::vector<uint32_t> stack;
    for (const auto& [a, b] : wanted) {
      const auto found = edge_of_.find(std::minmax(point_[a], point_[b]));
      if (found == edge_of_.end()) continue;
      for (uint32_t t = 0; t < count; ++t)
        for (const int e : cover_.edge[t])
          if (e == found->second && !out[t]) {
            out[t] = 1;
            stack.push_back(t);
          }
    }
    while (!stack.empty()) {
      const uint32_t t = stack.back();
      stack.pop_back();
      for (const uint32_t n : cover_.neighbours[t])
        if (n != no_index && !out[n]) {
          out[n] = 1;
          stack.push_back(n);
        }
    }
    return out;
  }

  bool is_on_plane(TriangleSide s) const {
    return split_.side[side_start(split_.mesh, s)] == 0 &&
           split_.side[side_end(split_.mesh, s)] == 0;
  }
  /// Of a vertex on the plane.
  uint32_t point(uint32_t vertex) const { return point_[vertex]; }
  /// A vertex that stands at a point.
  uint32_t vertex(uint32_t point) const { return vertex_[point]; }

 private:
  void add_points(TriangleSide s) {
    used_.push_back(side_start(split_.mesh, s));
    used_.push_back(side_end(split_.mesh, s));
  }

  /// Vertices at one place of the plane are one point.
  void number_points(const Vec3& normal) {
    int k = 0;
    normal.cwiseAbs().maxCoeff(&k);
    const int x = (k + 1) % 3, y = (k + 2) % 3;
    const bool turned = normal[k] < 0;
    const auto flat = [&](uint32_t v) {
      const Vec3& p = split_.mesh.vertices[v];
      return turned ? Vec2(p[y], p[x]) : Vec2(p[x], p[y]);
    };
    const auto place = [&](uint32_t v) {
      const Vec2 p = flat(v);
      return std::array<double, 2>{p.x(), p.y()};
    };
    std::sort(used_.begin(), used_.end());
    used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
    std::sort(used_.begin(), used_.end(), [&](uint32_t a, uint32_t b) {
      const auto pa = place(a), pb = place(b);
      return pa != pb ? pa < pb : a < b;
    });
    point_.assign(split_.mesh.vertices.size(), no_index);
    for (const uint32_t v : used_) {
      if (points_.empty() || points_.back() != flat(v)) {
        points_.push_back(flat(v));
        vertex_.push_back(v);
      }
      point_[v] = uint32_t(points_.size()) - 1;
    }
  }

  /// Where the solid goes on across the plane the section lies on the left of what runs along the
  /// solid over it.
  void add_edge(TriangleSide s, TriangleSide mate) {
    const uint32_t a = point_[side_start(split_.mesh, s)], b = point_[side_end(split_.mesh, s)];
    if (a == b) return;
    const auto [place, fresh] = edge_of_.try_emplace(std::minmax(a, b), int(edges_.size()));
    if (fresh) edges_.push_back({std::min(a, b), std::max(a, b), 0});
    if (split_.belongs[s / 3] == 1 && split_.belongs[mate / 3] == -1)
      edges_[size_t(place->second)].turns += a < b ? 1 : -1;
  }

  const SplitMesh& split_;
  std::vector<uint32_t> used_, point_, vertex_;
  std::vector<Vec2> points_;
  std::vector<PlanarEdge> edges_;
  std::map<std::pair<uint32_t, uint32_t>, int> edge_of_;
  PlanarCover cover_;
};

/// The split mesh with the selected part of the section as a face of both sides, and which sides of
/// triangles belong together.
class Closing {
 public:
  Closing(SplitMesh split, const Section& section, std::span<const char> selected, uint32_t plane)
      : mesh_(std::move(split.mesh)),
        plane_(std::move(split.plane)),
        mates_(std::move(split.mates)),
        section_(section) {
    find_walls(split.belongs);
    for (const int belongs : {1, -1}) add_face(selected, belongs, belongs > 0 ? plane + 1 : plane);
    for (TriangleSide s = 0; s < mates_.size() && sound_; ++s)
      sound_ = mates_[s] != no_index && mates_[mates_[s]] == s;
  }

  bool sound() const { return sound_; }
  std::vector<SolidPiece> solids(double tolerance, double& lost) const {
    return separate_solids(mesh_, plane_, mates_, tolerance, lost);
  }

 private:
  using Way = std::array<uint32_t, 2>;  // from point to point

  /// Sides on the plane of the triangles that stand on either side of it.
  void find_walls(const std::vector<int>& belongs) {
    for (TriangleSide s = 0; s < mates_.size(); ++s) {
      if (!section_.is_on_plane(s)) continue;
      const Way way{section_.point(side_start(mesh_, s)), section_.point(side_end(mesh_, s))};
      if (way[0] != way[1]) walls_[belongs[s / 3] > 0][way].push_back(s);
    }
  }

  void add_face(std::span<const char> selected, int belongs, uint32_t plane) {
    const PlanarCover& cover = section_.cover();
    std::vector<uint32_t> number(cover.triangles.size(), no_index);
    for (size_t t = 0; t < cover.triangles.size(); ++t) {
      if (!selected[t]) continue;
      number[t] = uint32_t(mesh_.triangles.size());
      Triangle v;
      for (size_t k = 0; k < 3; ++k) v[k] = section_.vertex(cover.triangles[t][k]);
      // The solid over the plane looks down at it.
      if (belongs > 0) std::swap(v[0], v[1]);
      mesh_.triangles.push_back(v);
      plane_.push_back(plane);
    }
    mates_.resize(3 * mesh_.triangles.size(), no_index);
    // Side k of a triangle of the cover in the face; turned round, 0 stays and 1 and 2 change.
    const auto side = [&](size_t t, size_t k) {
      return TriangleSide(3 * number[t] + (belongs > 0 && k > 0 ? 3 - k : k));
    };
    for (size_t t = 0; t < cover.triangles.size(); ++t) {
      if (number[t] == no_index) continue;
      for (size_t k = 0; k < 3; ++k) {
        const TriangleSide s = side(t, k);
        if (cover.edge[t][k] >= 0 && mate_with_wall(s, belongs > 0)) continue;
        const uint32_t n = cover.neighbours[t][k];
        if (n == no_index || number[n] == no_index) {
          sound_ = false;  // the face ends, and no wall stands there
          return;
        }
        for (size_t j = 0; j < 3; ++j)
          if (cover.neighbours[n][j] == t &&
              cover.triangles[n][j] == cover.triangles[t][(k + 1) % 3])
            mates_[s] = side(n, j);
      }
    }
  }

  /// Joins a side of the new face to the triangle that stands on it, if one does.
  bool mate_with_wall(TriangleSide s, bool over) {
    const Way back{section_.point(side_end(mesh_, s)), section_.point(side_start(mesh_, s))};
    const auto found = walls_[over].find(back);
    if (found == walls_[over].end()) return false;
    if (found->second.size() != 1) sound_ = false;  // which of them cannot be told
    mates_[s] = found->second[0];
    mates_[found->second[0]] = s;
    return true;
  }

  TriangleMesh mesh_;
  std::vector<uint32_t> plane_;
  std::vector<TriangleSide> mates_;
  const Section& section_;
  std::map<Way, std::vector<TriangleSide>> walls_[2];  ///< beneath and over
  bool sound_ = true;
};

}  // namespace

std::optional<CutResult> cut_solid(const SolidPiece& piece, const CutRequest& request) {
  const SplitMesh split = Splitter(piece, request).split();
  Section section(split, split.mates, request.plane.normal);
  if (!section.triangulate()) return std::nullopt;
  const std::vector<char> selected = section.selected(request.edges);
  if (std::find(selected.begin(), selected.end(), 1) == selected.end()) return std::nullopt;
  const Closing closing(split, section, selected, request.plane_number);
  if (!closing.sound()) return std::nullopt;
  CutResult out;
  out.pieces = closing.solids(request.tolerance, out.lost);
  return out;
}

}  // namespace tumble
