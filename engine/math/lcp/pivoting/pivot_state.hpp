#pragma once
#include "engine/math/lcp/pivoting/ldl.hpp"
#include "engine/math/lcp/report.hpp"
#include "engine/math/lcp/scaling.hpp"
#include "engine/math/lcp/tolerances.hpp"
#include "engine/math/lu.hpp"

#include <cstdint>

namespace tumble::lcp {

/// Position of an unknown relative to its bounds.
enum class Place : uint8_t { lower, between, upper };

/// Behaviour of an unknown while another is driven.
enum class Role : uint8_t {
  at_bound,  ///< stays at a bound (axial: the group is open, all three unknowns are 0)
  clamped,   ///< moves so that its w does not change
  /// Free, but does not move: its w is still wrong, or its row depends on clamped ones.
  resting,
  tied,  ///< a lateral on the cone's surface: moves with the axial unknown
};

/// A point of principal pivoting, with cones or without; z and w = A z + b are kept in scaled
/// units. Without groups L D L^T of the clamped unknowns is updated with each exchange; with groups
/// the matrix is not symmetric if laterals are tied, and is factored anew for each direction. The
/// lateral axes of circular undecided groups are rotated: on the surface, the first axis is the
/// direction of z_lateral.
class PivotState {
 public:
  PivotState(ScaledProblem problem, const std::vector<ConeGroup>& groups);

  struct Group {
    ConeGroup cone;
    std::array<double, 2> tie{};  ///< z_lateral[k] = tie[k] z_axial where tied
    double cosine = 1, sine = 0;  ///< direction of the first axis in the problem's axes
    bool open(const PivotState& s) const { return s.role[size_t(cone.axial)] == Role::at_bound; }
    /// Whether the laterals are always tied: their direction is prescribed, or the cone has no
    /// width.
    bool prescribed() const { return cone.mode == ConeMode::sliding || cone.slope == 0; }
    bool round() const { return !prescribed() && cone.shape == ConeShape::circular; }
  };

  ScaledProblem problem;
  const int n;
  std::vector<Group> groups;
  std::vector<int> group_of;  ///< -1: none
  std::vector<Role> role;
  std::vector<Place> place;
  /// W differs from 0 by no more than the rounding of dependent rows can explain.
  std::vector<char> excused;
  VecX z, w;
  int pivots = 0;
  double magnitude = 0;  ///< of the terms that add up to w, the scale of its rounding errors

  double tolerance() const { return tolerances::w_rounding * magnitude; }
  bool is_clamped(int i) const { return role[size_t(i)] == Role::clamped; }
  bool is_fixed(int i) const { return problem.lower[i] == problem.upper[i]; }
  bool is_axial(int i) const { return grouped(i) && group(i).cone.axial == i; }
  bool is_lateral(int i) const { return grouped(i) && group(i).cone.axial != i; }
  bool grouped(int i) const { return group_of[size_t(i)] >= 0; }
  const Group& group(int i) const { return groups[size_t(group_of[size_t(i)])]; }
  Group& group(int i) { return groups[size_t(group_of[size_t(i)])]; }
  /// Violation of the condition of an unknown; 0 for clamped, fixed and excused ones.
  double wrong(int i) const;
  /// For a tied lateral: its w in the direction of z, which must not be positive.
  double outward(int i) const;
  /// Distance of z_i beyond its bounds: negative below the lower, positive above the upper.
  double beyond(int i) const;

  /// The clamped unknowns; with groups, those of the last direction().
  const std::vector<int>& members() const { return groups.empty() ? factor_.members() : clamped_; }
  /// Changes of z, and of w, per unit of unknown l, with the clamped and tied unknowns following.
  /// False if the matrix is singular.
  bool direction(int l, double sign, VecX& dz, VecX& dw);
  /// Rate of the driven unknown's w in the last direction: a Schur complement.
  double remainder() const { return remainder_; }
  /// Clamps the driven unknown of the last direction, if its Schur complement is not zero.
  void enter_driven(int l);
  /// Clamps i, unless its Schur complement is less than `least`.
  bool enter(int i, double least);
  /// Puts an unknown without group at one of its bounds.
  void leave(int i, Place to);
  /// Sets the clamped unknowns at `positions` (ascending) to their nearer bounds; recomputes the
  /// factor if that is less work.
  void leave_many(const std::vector<int>& positions);
  /// Without groups: solves for z of the clamped unknowns, then computes w.
  void solve();
  /// Without groups: one step of iterative refinement of the clamped unknowns.
  void refine();

  /// Rotates the lateral axes of a circular group so that the first is along (x, y), given in the
  /// present axes; nothing if that is 0.
  void turn(Group& g, double x, double y);
  /// Ties the laterals: along z, where they have reached the cone's surface; or against w, as they
  /// would slip if the axial unknown increased from 0.
  void tie_along_z(Group& g);
  void tie_against_w(Group& g);
  void open(Group& g);

  /// z, or a direction, in the problem's units and axes.
  VecX in_own_units(const VecX& from) const;
  /// Hash of roles and places.
  uint64_t signature() const;

 private:
  double reduce(int i);
  void append(int i, double remainder);
  void factor_anew(const std::vector<int>& members);
  bool factor_tied();
  double tied_entry(int row, int column) const;
  void renew_w();

  LdlFactor factor_;
  LuFactor lu_;
  std::vector<int> clamped_;
  std::vector<double> x_, y_;
  double remainder_ = 0;
};

}  // namespace tumble::lcp
