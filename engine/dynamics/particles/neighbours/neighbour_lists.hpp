#pragma once
#include "engine/core/crew.hpp"
#include "engine/core/result.hpp"
#include "engine/dynamics/particles/neighbours/candidates.hpp"
#include "engine/dynamics/particles/neighbours/cell_order.hpp"
#include "engine/dynamics/particles/neighbours/periodic_box.hpp"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// For each of many points, the others within a distance: shared by potentials, grains and fluids.
/// Points are sorted by the cells of a grid along a space-filling curve, so that neighbours are
/// near in memory; a point's index in that order is its *place*. The points are followed by ghosts,
/// which are copies of points outside of a periodic box, and by one place far from everything,
/// which pads lists to a multiple of eight, those of groups to one of four.
///
/// With a skin the lists reach farther than asked for, and stay valid until a point has moved by
/// half of the skin (Verlet 1967).
class NeighbourLists {
 public:
  static constexpr size_t batch = 8;       ///< lists are padded to a multiple of it
  static constexpr size_t group_size = 4;  ///< most points of a group
  /// Behind the list of a group as many numbers more can be read: for the most part those of the
  /// next lists, whose points can so be fetched in advance.
  static constexpr size_t look_ahead = 64;

  struct Request {
    double reach = 0;      ///< points whose distance is at most this are neighbours [m]
    double skin = 0;       ///< additional distance [m]
    PeriodicBox box = {};  ///< edges no shorter than reach + skin along periodic axes
    /// Orders lists by the caller's indices, and copies of one point by their shifts, instead of by
    /// the grid: the order of neighbours within reach then depends on the points only, not on when
    /// and with which skin the lists were made.
    bool by_index = false;
    /// Makes one list for each group of points that follow each other, instead of one for each
    /// point.
    bool by_group = false;
    bool operator==(const Request&) const = default;
  };

  /// Sets the points' positions x [m], in an order of the caller that must stay the same from call
  /// to call. Makes order and lists anew if necessary; returns whether it was. Error if a
  /// coordinate is not finite, the reach not positive, or a periodic box shorter than the reach.
  Result<bool> update(std::span<const Vec3> x, const Request& request, Crew* crew);
  /// The next update() makes order and lists anew, in the memory that there is.
  void forget() { request_ = {}; }
  /// Whether the lists that were made for this request are valid for points at x.
  bool hold(std::span<const Vec3> x, const Request& request, Crew* crew) const;

  size_t size() const { return order_.size(); }
  /// Number of points, ghosts and the far place: the length of arrays by place.
  size_t places() const { return px_.size(); }
  /// By place: the caller's index.
  std::span<const uint32_t> order() const { return order_; }
  /// By ghost, the first of which is at place size(): the place of the point that it copies.
  std::span<const uint32_t> ghost_owners() const { return ghost_owners_; }

  /// Coordinates by place [m]; along periodic axes inside the box when lists were last made. Each
  /// is PeriodicBox::wrapped() plus a whole number of edges.
  std::span<const double> x() const { return px_; }
  std::span<const double> y() const { return py_; }
  std::span<const double> z() const { return pz_; }

  /// Places of all neighbours of the point at `place` < size(), and of some that are farther by up
  /// to the skin; without itself. Padded to a multiple of `batch` with the far place.
  std::span<const uint32_t> of(size_t place) const {
    const List& l = lists_[place];
    return {stores_[l.store].data() + l.first, l.padded};
  }
  /// Number of entries that are not padding.
  uint32_t count(size_t place) const { return lists_[place].count; }
  /// With Request::by_group: points of one cell, and one list for all of them.
  struct Group {
    uint32_t first, count;          ///< places
    uint32_t store, begin, padded;  ///< the list
  };
  std::span<const Group> groups() const { return groups_; }
  /// Places of what is within reach and skin of any point of a group, and of these themselves,
  /// padded to a multiple of four.
  std::span<const uint32_t> of(const Group& g) const {
    return {stores_[g.store].data() + g.begin, g.padded};
  }
  /// With Request::by_index: how many of them precede the point itself in the order, so that each
  /// pair can be visited once.
  uint32_t before(size_t place) const { return lists_[place].before; }
  /// Whether the point has left the periodic box since the lists were made.
  bool strayed(size_t place) const {
    return !edges_.empty() && edges_[place] != std::array<int8_t, 3>{};
  }
  /// Position of another place [m] relative to the copy of the point at `place` inside the box:
  /// bitwise as if the lists had been made now.
  Vec3 beside(size_t place, size_t other) const;

 private:
  class ListWriter;
  struct List {
    uint32_t store, first, count, padded, before;
  };
  uint32_t owner(size_t place) const {
    return place < size() ? uint32_t(place) : ghost_owners_[place - size()];
  }
  void place_points(std::span<const Vec3> x, Crew* crew);
  void add_ghosts();
  void number_places();
  void sort_octants(std::span<const Vec3> points);
  /// f(chunk, cell's index, its candidates) for all cells.
  template <class F>
  void each_cell(Crew* crew, const F& f);
  void list_cells(Crew* crew);
  void list_groups(Crew* crew);
  void move(std::span<const Vec3> x, Crew* crew);

  Request request_;
  std::vector<uint32_t> order_, ghost_owners_;
  using Edges = std::array<int8_t, 3>;  ///< whole numbers of edges of the periodic box
  std::vector<Edges> ghost_edges_;      ///< from each point to its ghost, when lists were made
  /// By place: edges since the lists were made from inside the box; empty without a box.
  std::vector<Edges> edges_;
  /// By the caller's index: position inside the box; empty without one.
  std::vector<Vec3> wrapped_;
  std::vector<uint32_t> ordinals_;  ///< by place, with Request::by_index
  std::vector<double> px_, py_, pz_;
  std::vector<double> from_x_, from_y_, from_z_;  ///< by place: positions when lists were made [m]
  CellOrder cells_, ghost_cells_;
  std::vector<List> lists_;
  std::vector<Group> groups_;
  std::vector<uint32_t> first_group_;          ///< by cell
  std::vector<std::vector<uint32_t>> stores_;  ///< by chunk of cells
  // Scratch memory.
  std::vector<std::pair<int, uint32_t>> octants_;
  std::vector<Vec3> ghost_points_;
  std::vector<Edges> copies_;
  std::vector<uint32_t> owners_, firsts_;
  std::vector<Candidates> candidates_;  ///< by chunk
};

}  // namespace tumble
