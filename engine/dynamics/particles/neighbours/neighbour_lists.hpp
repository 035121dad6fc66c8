#pragma once
#include "engine/core/crew.hpp"
#include "engine/core/result.hpp"
#include "engine/dynamics/particles/neighbours/candidates.hpp"
#include "engine/dynamics/particles/neighbours/cell_order.hpp"
#include "engine/dynamics/particles/neighbours/periodic_box.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// For each of many points, which others are within a distance of it: shared by potentials, grains
/// and fluids. Points are sorted by the cells of a grid along a space-filling curve, so that those
/// which are near each other are near in memory; a point's index in that order is its *place*.
/// Behind the points stand ghosts, the copies of points that a periodic box has beside itself, and
/// one last place that is far from everything, which fills lists up to a multiple of eight.
///
/// With a skin lists hold a little more than was asked for, and stay right until a point has moved
/// by half of the skin (Verlet 1967).
class NeighbourLists {
 public:
  static constexpr size_t batch = 8;  ///< lists are filled up to a multiple of it

  struct Request {
    double reach = 0;      ///< centres that are no farther apart are neighbours [m]
    double skin = 0;       ///< [m]
    PeriodicBox box = {};  ///< no shorter than reach + skin along periodic axes
    /// Lists in the order of the caller's indices, copies of one point in that of their shifts, in
    /// place of that of the grid: what is within reach is then in an order that only the points
    /// decide, whenever and with whatever skin lists were made.
    bool by_index = false;
    bool operator==(const Request&) const = default;
  };

  /// The points are now at x [m], in an order of the caller that stays from call to call. Makes
  /// order and lists anew where that is needed; says whether it was. Refuses coordinates that are
  /// not finite, a reach that is not positive, and a periodic box shorter than the reach.
  Result<bool> update(std::span<const Vec3> x, const Request& request, Crew* crew);
  /// Whether lists that were made for this request are right for points at x.
  bool hold(std::span<const Vec3> x, const Request& request, Crew* crew) const;

  size_t size() const { return order_.size(); }
  /// Points, ghosts and the far place: how long arrays by place have to be.
  size_t places() const { return px_.size(); }
  /// By place the caller's index.
  std::span<const uint32_t> order() const { return order_; }
  /// By ghost, the first of which is at place size(): the place of the point whose copy it is.
  std::span<const uint32_t> ghost_owners() const { return ghost_owners_; }

  /// Coordinates by place [m]; inside the box along periodic axes when lists were made last. Each
  /// is PeriodicBox::wrapped() and a whole number of edges.
  std::span<const double> x() const { return px_; }
  std::span<const double> y() const { return py_; }
  std::span<const double> z() const { return pz_; }

  /// Places of all neighbours of the point at `place` < size(), and of some that are up to the skin
  /// farther; without itself. Filled up to a multiple of `batch` with the far place.
  std::span<const uint32_t> of(size_t place) const {
    const List& l = lists_[place];
    return {stores_[l.store].data() + l.first, l.padded};
  }
  /// How many of them are not filling.
  uint32_t count(size_t place) const { return lists_[place].count; }
  /// With Request::by_index: how many of them come before the point itself, so that of each pair
  /// one comes before the other.
  uint32_t before(size_t place) const { return lists_[place].before; }
  /// Whether the point has left the periodic box since lists were made.
  bool strayed(size_t place) const {
    return !edges_.empty() && edges_[place] != std::array<int8_t, 3>{};
  }
  /// What is at another place [m], seen from where the point at `place` is in the box: the same
  /// numbers as if lists had been made now.
  Vec3 beside(size_t place, size_t other) const;

 private:
  struct List {
    uint32_t store, first, count, padded, before;
  };
  uint32_t owner(size_t place) const {
    return place < size() ? uint32_t(place) : ghost_owners_[place - size()];
  }
  void place_points(std::span<const Vec3> x, Crew* crew);
  void add_ghosts();
  void number_places();
  void list_cells(Crew* crew);
  void move(std::span<const Vec3> x, Crew* crew);

  Request request_;
  std::vector<uint32_t> order_, ghost_owners_;
  using Edges = std::array<int8_t, 3>;  ///< whole numbers of edges of the periodic box
  std::vector<Edges> ghost_edges_;      ///< from the point to its copy, when lists were made
  std::vector<Edges> edges_;        ///< by place: from where it is in the box; empty without one
  std::vector<Vec3> wrapped_;       ///< by the caller's index: in the box; empty without one
  std::vector<uint32_t> ordinals_;  ///< by place, with Request::by_index
  std::vector<double> px_, py_, pz_;
  std::vector<double> from_x_, from_y_, from_z_;  ///< by place: where lists were made [m]
  CellOrder cells_, ghost_cells_;
  std::vector<List> lists_;
  std::vector<std::vector<uint32_t>> stores_;  ///< by chunk of cells
  // scratch
  std::vector<Vec3> ghost_points_;
  std::vector<Edges> copies_;
  std::vector<uint32_t> owners_, firsts_;
  std::vector<Candidates> candidates_;  ///< by chunk
};

}  // namespace tumble
