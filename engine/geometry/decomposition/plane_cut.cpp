#include "engine/geometry/decomposition/plane_cut.hpp"

#include "engine/core/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

class Cutter {
 public:
  using Side = SolidPiece::Side;
  using Face = SolidPiece::Face;

  Cutter(ExactSpace& space, SolidPiece piece, const CutRequest& request)
      : space_(space),
        request_(request),
        sides_(std::move(piece.sides)),
        faces_(std::move(piece.faces)),
        across_(sides_.size(), no_index) {}

  std::optional<std::vector<SolidPiece>> cut() {
    const size_t before = faces_.size();
    for (uint32_t f = 0; f < before; ++f) divide(f, request_.plane);
    first_new_ = uint32_t(faces_.size());
    add_section();
    make_convex(first_new_);
    make_convex(first_new_ + 1);
    if (!sound_) return std::nullopt;
    keep_selected();
    return separate_solids(space_, {std::move(sides_), std::move(faces_)}, request_.skin,
                           request_.left_out);
  }

 private:
  int side_of(uint32_t plane, uint32_t point) {
    if (plane != request_.plane) return space_.side(plane, point);
    if (point >= known_.size()) known_.resize(space_.point_count(), unknown);
    int8_t& known = known_[point];
    if (known == unknown) known = int8_t(space_.side(plane, point));
    return known;
  }

  /// Splits an edge at a point, and also the edge that coincides with it on the other side of the
  /// section.
  void split(uint32_t s, uint32_t point) {
    const uint32_t t = sides_[s].mate;
    const uint32_t wall = across_[s] != no_index ? s : across_[t] != no_index ? t : no_index;
    const uint32_t other = wall == no_index ? no_index : across_[wall];
    const uint32_t rest = split_pair(wall == no_index ? s : wall, point);
    if (other == no_index) return;
    // The coincident half-edge on the other side has the opposite direction.
    const uint32_t beyond = split_pair(other, point);
    link_across(wall, beyond);
    link_across(rest, other);
  }
  void link_across(uint32_t a, uint32_t b) {
    across_[a] = b;
    across_[b] = a;
  }
  /// Makes the new half-edge, from the point to the end of s.
  uint32_t split_pair(uint32_t s, uint32_t point) {
    const uint32_t t = sides_[s].mate, s2 = uint32_t(sides_.size()), t2 = s2 + 1;
    for (const uint32_t side : {s, t}) {
      sides_.push_back(sides_[side]);
      sides_.back().start = point;
      sides_[side].end = point;
      faces_[sides_[side].face].sides.push_back(uint32_t(sides_.size()) - 1);
      across_.push_back(no_index);
    }
    sides_[s].mate = t2;
    sides_[t2].mate = s;
    sides_[s2].mate = t;
    sides_[t].mate = s2;
    return s2;
  }

  /// Whether a face has points on both sides of a plane.
  bool crosses(uint32_t f, uint32_t plane) {
    bool over = false, beneath = false;
    for (const uint32_t s : faces_[f].sides) {
      const int side = side_of(plane, sides_[s].start);
      over = over || side > 0;
      beneath = beneath || side < 0;
      if (over && beneath) return true;
    }
    return false;
  }

  /// Divides a face that crosses a plane along it; the part below becomes a new face.
  bool divide(uint32_t f, uint32_t plane) {
    if (!crosses(f, plane)) return false;
    for (size_t i = 0; i < faces_[f].sides.size(); ++i) {
      const uint32_t s = faces_[f].sides[i];
      if (side_of(plane, sides_[s].start) * side_of(plane, sides_[s].end) < 0)
        split(s, space_.add_point(sides_[s].line[0], sides_[s].line[1], plane));
    }
    find_stations(f, plane);
    divide_sides_on_line(f);
    const auto beneath = uint32_t(faces_.size());
    faces_.push_back({faces_[f].plane, faces_[f].turned, faces_[f].cavity, {}});
    share_sides(f, beneath, plane);
    return true;
  }

  /// Collects the points of a face on the line, in their order along it; points at the same place
  /// form one station. The part above the plane is to the left of the line.
  void find_stations(uint32_t f, uint32_t plane) {
    std::vector<uint32_t> on;
    for (const uint32_t s : faces_[f].sides)
      for (const uint32_t p : {sides_[s].start, sides_[s].end})
        if (side_of(plane, p) == 0) on.push_back(p);
    std::sort(on.begin(), on.end());
    on.erase(std::unique(on.begin(), on.end()), on.end());
    ExactSpace::Along line = space_.along(plane, faces_[f].plane);
    if (faces_[f].turned) line.sign = -line.sign;
    std::stable_sort(on.begin(), on.end(),
                     [&](uint32_t a, uint32_t b) { return space_.order(line, a, b) < 0; });
    stations_.clear();
    station_of_.clear();
    for (const uint32_t p : on) {
      if (stations_.empty() || space_.order(line, stations_.back(), p) != 0) stations_.push_back(p);
      station_of_.emplace_back(p, uint32_t(stations_.size()) - 1);
    }
    std::sort(station_of_.begin(), station_of_.end());
  }
  /// The station of a point; no_index if it is not on the line.
  uint32_t station(uint32_t point) const {
    const auto found = std::lower_bound(station_of_.begin(), station_of_.end(),
                                        std::pair<uint32_t, uint32_t>(point, 0));
    return found != station_of_.end() && found->first == point ? found->second : no_index;
  }
  void divide_sides_on_line(uint32_t f) {
    for (size_t i = 0; i < faces_[f].sides.size(); ++i) {
      const uint32_t s = faces_[f].sides[i];
      const uint32_t a = station(sides_[s].start), b = station(sides_[s].end);
      if (a == no_index || b == no_index) continue;
      if (a + 1 < b) split(s, stations_[a + 1]);
      if (b + 1 < a) split(s, stations_[a - 1]);
    }
  }

  /// Assigns to each part its half-edges, and to both parts the segments of the line between them:
  /// as many half-edges enter a station as leave it.
  void share_sides(uint32_t f, uint32_t beneath, uint32_t plane) {
    std::vector<int> over_line(stations_.size(), 0), beneath_line = over_line;
    std::vector<int> along = over_line, against = over_line;  // half-edges that exist already
    std::vector<uint32_t> kept;
    for (const uint32_t s : faces_[f].sides) {
      const uint32_t a = station(sides_[s].start), b = station(sides_[s].end);
      bool over = false;
      if (a != no_index && b != no_index) {
        over = a < b;
        ++(over ? along : against)[std::min(a, b)];
      } else {
        over = side_of(plane, a == no_index ? sides_[s].start : sides_[s].end) > 0;
        if (a != no_index) over ? --over_line[a] : ++beneath_line[a];
        if (b != no_index) over ? ++over_line[b] : --beneath_line[b];
      }
      if (over) {
        kept.push_back(s);
      } else {
        faces_[beneath].sides.push_back(s);
        sides_[s].face = beneath;
      }
    }
    faces_[f].sides = std::move(kept);
    int count_over = 0, count_beneath = 0;
    for (uint32_t k = 0; k < stations_.size(); ++k) {
      count_over += over_line[k];
      count_beneath += beneath_line[k];
      const int over = count_over - along[k], under = count_beneath - against[k];
      sound_ = sound_ && over == under && (over == 0 || (over == 1 && k + 1 < stations_.size()));
      if (sound_ && over == 1)
        add_pair(stations_[k], stations_[k + 1], f, beneath, {faces_[f].plane, plane});
    }
  }

  /// Adds an edge from a to b, with one face on its left and one on its right.
  void add_pair(uint32_t a, uint32_t b, uint32_t left, uint32_t right,
                const std::array<uint32_t, 2>& line) {
    const auto s = uint32_t(sides_.size());
    sides_.push_back({a, b, s + 1, left, line});
    sides_.push_back({b, a, s, right, line});
    faces_[left].sides.push_back(s);
    faces_[right].sides.push_back(s + 1);
    across_.resize(sides_.size(), no_index);
  }

  /// Whether a face that the plane does not cross belongs to the solid above the plane (1) or below
  /// (-1).
  int belongs(uint32_t f) {
    for (const uint32_t s : faces_[f].sides)
      if (const int side = side_of(request_.plane, sides_[s].start)) return side;
    // In the plane: the solid is behind the face.
    const double up = space_.plane(faces_[f].plane).normal.dot(space_.plane(request_.plane).normal);
    return (up > 0) != faces_[f].turned ? -1 : 1;
  }

  /// Adds the section as a face of the solid above the plane and one of the solid below, bounded by
  /// the edges where the solid continues across the plane. A reflex edge that only touches the
  /// plane, with both faces on one side, divides the section on that side.
  void add_section() {
    faces_.push_back({request_.plane, true, false, {}});
    faces_.push_back({request_.plane, false, false, {}});
    std::vector<int> belongs_to(first_new_);
    for (uint32_t f = 0; f < first_new_; ++f) belongs_to[f] = belongs(f);
    const size_t count = sides_.size();
    for (uint32_t s = 0; s < count; ++s) {
      const uint32_t m = sides_[s].mate;
      if (m < s || across_[s] != no_index || side_of(request_.plane, sides_[s].start) != 0 ||
          side_of(request_.plane, sides_[s].end) != 0)
        continue;
      const int own = belongs_to[sides_[s].face], other = belongs_to[sides_[m].face];
      if (own == other && sides_[s].edge == no_index) continue;
      for (const auto& [wall, side] : {std::pair(s, own), std::pair(m, other)}) {
        const uint32_t face = first_new_ + (side > 0 ? 0 : 1);
        faces_[face].sides.push_back(uint32_t(sides_.size()));
        sides_.push_back(
            {sides_[wall].end, sides_[wall].start, wall, face, sides_[wall].line, no_index});
        across_.push_back(no_index);
        sides_[wall].mate = uint32_t(sides_.size()) - 1;
      }
      link_across(s, m);
    }
  }

  /// Divides a face along the lines of its edges until it is convex.
  void make_convex(uint32_t face) {
    std::vector<uint32_t> waiting{face};
    while (!waiting.empty() && sound_) {
      const uint32_t f = waiting.back();
      waiting.pop_back();
      for (size_t i = 0; i < faces_[f].sides.size(); ++i) {
        if (!divide(f, wall_of(faces_[f].sides[i]))) continue;
        waiting.push_back(uint32_t(faces_.size()) - 1);
        waiting.push_back(f);
        break;
      }
    }
  }
  /// Of the two planes that define the line of a half-edge, the one that is more perpendicular to
  /// its face.
  uint32_t wall_of(uint32_t s) const {
    const Vec3& normal = space_.plane(faces_[sides_[s].face].plane).normal;
    const auto& [p, q] = sides_[s].line;
    return space_.plane(p).normal.cross(normal).squaredNorm() >
                   space_.plane(q).normal.cross(normal).squaredNorm()
               ? p
               : q;
  }

  /// Undoes those parts of the section that were not requested.
  void keep_selected() {
    const std::vector<char> selected = selected_faces();
    for (uint32_t s = 0; s < sides_.size(); ++s) {
      if (across_[s] == no_index) continue;
      if (selected[sides_[sides_[s].mate].face]) {
        sides_[s].edge = no_index;
      } else {
        sides_[s].mate = across_[s];
      }
    }
    for (uint32_t f = first_new_; f < faces_.size(); ++f)
      if (!selected[f]) faces_[f].sides.clear();
  }

  /// New faces of the requested parts of the section.
  std::vector<char> selected_faces() {
    DisjointSets parts(faces_.size());
    for (uint32_t f = first_new_; f < faces_.size(); ++f)
      for (const uint32_t s : faces_[f].sides) {
        const uint32_t mate = sides_[s].mate;
        parts.join(f, sides_[across_[mate] == no_index ? mate : sides_[across_[mate]].mate].face);
      }
    std::vector<char> chosen(faces_.size(), request_.touching < 0);
    const Plane& plane = space_.plane(request_.plane);
    for (const Side& s : sides_) {
      if (s.edge == no_index || request_.touching < 0) continue;
      const auto on_plane = [&](uint32_t p) {
        return std::fabs(plane.distance(space_.at(p))) <= request_.touching ||
               side_of(request_.plane, p) == 0;
      };
      if (!on_plane(s.start) || !on_plane(s.end)) continue;
      for (const uint32_t wall : faces_[s.face].sides)
        if (across_[wall] != no_index) chosen[parts.root(sides_[sides_[wall].mate].face)] = 1;
    }
    std::vector<char> out(faces_.size(), 0);
    for (uint32_t f = first_new_; f < faces_.size(); ++f) out[f] = chosen[parts.root(f)];
    return out;
  }

  static constexpr int8_t unknown = 2;
  ExactSpace& space_;
  const CutRequest& request_;
  std::vector<Side> sides_;
  std::vector<Face> faces_;
  /// For each half-edge on the boundary of the section, its former mate across the cut.
  std::vector<uint32_t> across_;
  std::vector<int8_t> known_;  ///< on which side of the cutting plane points are
  std::vector<uint32_t> stations_;
  std::vector<std::pair<uint32_t, uint32_t>> station_of_;  ///< by point
  uint32_t first_new_ = 0;
  bool sound_ = true;
};

}  // namespace

std::optional<std::vector<SolidPiece>> cut_solid(ExactSpace& space, SolidPiece piece,
                                                 const CutRequest& request) {
  return Cutter(space, std::move(piece), request).cut();
}

}  // namespace tumble
