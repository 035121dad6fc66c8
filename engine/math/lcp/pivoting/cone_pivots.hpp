#pragma once
#include "engine/math/lcp/pivoting/pivot_state.hpp"
#include "engine/math/lu.hpp"

namespace tumble::lcp {

/// What an unknown does while another is driven.
enum class Role : uint8_t {
  at_bound,  ///< stays at a bound (axial: the group is open, all three are 0)
  clamped,   ///< moves so that its w does not change
  resting,   ///< free to move, but does not: its w is still wrong, or depends on the clamped ones
  tied,      ///< a lateral on the cone's surface: moves with the axial unknown
};

/// A point of pivoting with cones, in scaled units. The lateral axes of circular undecided groups
/// are turned as needed: on the surface, the first is the direction of z_lateral.
class ConePivots {
 public:
  explicit ConePivots(const LcpProblem& problem);

  struct Group {
    ConeGroup cone;
    std::array<double, 2> tie{};  ///< z_lateral[k] = tie[k] z_axial where tied
    double cosine = 1, sine = 0;  ///< the first axis in the problem's axes
    bool open(const ConePivots& s) const { return s.role[size_t(cone.axial)] == Role::at_bound; }
    /// Laterals that are always tied: prescribed, or a cone without width.
    bool prescribed() const { return cone.mode == ConeMode::sliding || cone.slope == 0; }
    bool round() const { return !prescribed() && cone.shape == ConeShape::circular; }
  };

  int n;
  std::vector<Group> groups;
  std::vector<int> group_of;  ///< -1: none
  std::vector<Role> role;
  std::vector<Place> place;
  std::vector<char> excused;  ///< w misses 0 by what rounding in dependent rows can explain
  VecX z, w, lower, upper;
  double magnitude = 0;

  double tolerance() const { return 1e-13 * magnitude; }
  double at(int i, int j) const { return A_[size_t(j) * size_t(n) + size_t(i)]; }
  bool is_lateral(int i) const {
    return group_of[size_t(i)] >= 0 && groups[size_t(group_of[size_t(i)])].cone.axial != i;
  }
  bool is_axial(int i) const {
    return group_of[size_t(i)] >= 0 && groups[size_t(group_of[size_t(i)])].cone.axial == i;
  }

  /// Turns the lateral axes of a round group so that the first lies along (x, y), given in the
  /// present axes; nothing when that is 0.
  void turn(Group& g, double x, double y);
  /// Ties the laterals where the cone's surface is met on the way out, or where they would slip if
  /// the axial unknown grew from 0.
  void tie_along_z(Group& g);
  void tie_against_w(Group& g);
  void open(Group& g);
  /// By how much the condition of unknown i is not met yet; 0 for clamped and excused ones.
  double wrong(int i) const;
  /// For a tied lateral: its w in the direction of z, which must not be positive.
  double outward(int i) const;

  std::vector<int> clamped() const;
  /// Changes of z per unit of unknown l, with the clamped and tied ones following, and of w. False:
  /// singular.
  bool direction(int l, double sign, VecX& dz, VecX& dw);
  void renew_w();
  /// z in the problem's units and axes.
  VecX answer(bool ray, const VecX& from) const;
  uint64_t signature() const;

 private:
  double column_entry(int row, int column) const;
  bool factor(const std::vector<int>& c);
  void follow(VecX& dz) const;

  std::vector<double> A_, d_;
  VecX b_;
  LuFactor lu_;
};

}  // namespace tumble::lcp
