#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/realtime/solve_plan.hpp"
#include "engine/dynamics/realtime/wide/colouring.hpp"
#include "engine/dynamics/realtime/wide/joint_bundles.hpp"
#include "engine/dynamics/realtime/wide/wide_kernels.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class Crew;
/// Ordinary islands of one sort, solved together in bundles of contacts by colour. What does not
/// fit into bundles, the rest, is solved by the scalar rows within the same sweeps: other kinds of
/// joints, contacts of bodies that turn fast or are slender, and those without a colour. The result
/// of an island does not depend on which others are solved with it: lanes are independent, and
/// decisions that are made once for all follow from the sort. Memory is reused from tick to tick.
class WideIsland {
 public:
  /// Takes over the islands with indices `which`, all of the same sort. `traits`, by body slot,
  /// must live until the end of solve().
  void lay_out(const SolverContext& context, const IslandSet& islands,
               std::span<const uint32_t> which, std::span<const BodyTraits> traits, WideSort sort,
               Crew& crew);
  /// Runs all sub-steps; writes back bodies and impulses. The threads of `crew` share the work; the
  /// result does not depend on their number.
  SolveResiduals solve(const SolverContext& context, Crew& crew);

  void add_memory(MemoryUse& use) const;

  bool empty() const { return slots_.empty(); }
  size_t contacts() const { return edges_.size() + rest_rows_.size(); }
  size_t points() const { return points_; }
  size_t joints() const { return joints_.size() + joint_bundles_.size(); }
  size_t colours() const { return colours_.size(); }
  size_t rest_contacts() const { return rest_rows_.size(); }

 private:
  struct Bundle {
    uint32_t first_edge = 0, lanes = 0;  ///< range of by_count_
    uint32_t first_point = 0, count = 0;
    uint32_t turning = WideContact::no_turning;  ///< index of its WideTurning
  };
  /// One of the islands: its range of the rest, and how an impact spreads through it. That is
  /// continued for as long as it changes something in this island, however long it takes in others.
  struct Part {
    WideRange rows, joints;  ///< ranges of the rest
    /// Greatest change in the last round, as apply_restitution or blow_change returns it.
    double change = 0;
    bool struck = false;      ///< its bounces take part in another round
    bool remembered = false;  ///< impulses of its joints are remembered in this sub-step
    bool blown = false;       ///< and there was an impact
    bool bounces = false;     ///< contacts of it bounce in this tick
    double taken = 0;         ///< energy that was taken, see blow_energy [J]
    double share = 1;         ///< share of the impact that is kept
  };
  /// What is needed for the energy of impacts in islands with joints in which contacts bounce: the
  /// bundled points that bounce, as in PointRow, and all bundled joints of these islands, as in
  /// JointBlock.
  struct BlowBooks {
    struct Point {
      uint32_t contact, point, lane, part;
      double speed = 0, normal = 0;
    };
    struct Joint {
      uint32_t joint, lane, part;
      std::array<double, 5> speeds{};
      std::array<float, 5> relaxing{};
    };
    std::vector<Point> points;
    std::vector<Joint> joints;
    std::vector<WideBody> bodies;  ///< before the impact
    bool open = false;             ///< some island bounces
  };
  void clear(const SolverContext& context, std::span<const uint32_t> involved);
  void add_bodies(const SolverContext& context, const IslandSet& islands,
                  std::span<const uint32_t> which);
  uint32_t add_body(uint32_t slot);
  uint32_t find(uint32_t slot);
  uint32_t in_rest(uint32_t body);
  void add_contact(const SolverContext& context, const IslandSet& islands, uint32_t source);
  void add_rest_row(uint32_t source, const IslandSet::Ends& ends);
  void add_joint(const SolverContext& context, uint32_t source);
  void add_rest_joint(const SolverContext& context, uint32_t source);
  void bundle();
  void part(const IslandSet& islands, std::span<const uint32_t> which);
  template <class Row>
  void part_rest(std::vector<Row>& rows, WideRange Part::*range);
  /// The part of a constraint between two bodies, at least one of which is in an island.
  uint32_t part_of(uint32_t a, uint32_t b) const {
    return islands_[a] < parts_.size() ? islands_[a] : islands_[b];
  }

  void prepare(const SolverContext& context, Crew& crew, const WideStep& step, double hs);
  void substep(const SolverContext& context, Crew& crew, const WideStep& step, double hs,
               int index);
  void start(const SolverContext& context, Crew& crew, const WideStep& step, double h);
  void find_free_speeds(Crew& crew, double hs);
  void follow_limits(Crew& crew, double hs);
  void follow_with_armatures(Crew& crew, double hs);
  void solve_struck_joints(Crew& crew, double hs, JointPass pass, double least);
  void bounce(const SolverContext& context, Crew& crew, double hs);
  void bounce_in_turn(const SolverContext& context, Crew& crew, double hs);
  void bounce_bundles(Crew& crew);
  void open_blow_books();
  void note_blow_speeds(double share);
  void add_taken(JointPass pass);
  void remember_before_blow();
  void bound_blows();
  void scale_blows();
  double normal_speed(const BlowBooks::Point& p) const;
  std::array<double, 5> row_speeds(const BlowBooks::Joint& j) const;
  size_t rows_of(const BlowBooks::Joint& j) const;
  float& row_impulse(const BlowBooks::Joint& j, size_t row, JointPass pass);
  bool read_blow_changes();
  void end_blows();
  void mark_struck(WideRange joints, double least);
  template <class Is, class F>
  void for_impulses_of(const Is& is, const F& f);
  template <class Is>
  void remember(const Is& is);
  void end_substep(Crew& crew, double hs);
  SolveResiduals store(const SolverContext& context, Crew& crew, double hs);
  template <class F>
  void each_block(Crew& crew, uint32_t bodies, const F& f);
  template <class F>
  void each_colour(Crew& crew, const F& f);
  /// Runs f(scalar rows) between reading and writing the velocities of their bodies.
  template <class F>
  void with_rest(const F& f) {
    if (rest_bodies_.empty()) return;
    read_velocities();
    f(rest());
    write_velocities();
  }
  template <class F>
  void sweep_bundled_joints(Crew& crew, JointSweeps which, const F& f);
  void kick(Crew& crew, double h);
  void warm_start_bundled_joints(Crew& crew, const WideStep& step, JointPass pass);
  void sum_all_joints(Crew& crew, double hs, JointPass pass);
  void solve_bundled_joints(Crew& crew, JointPass pass);
  WideRange all_joints() const { return {0, joint_bundles_.bundles()}; }
  WideRange all_bundles() const { return {0, uint32_t(bundles_.size())}; }

  void stage_bodies(const SolverContext& context, double hs, uint32_t begin, uint32_t end);
  void stage_bundle(const SolverContext& context, uint32_t bundle);
  void fetch_contacts(const SolverContext& context, uint32_t bundle) const;
  void stage_contacts(const SolverContext& context, WideRange bundles);
  void stage_rest(const SolverContext& context, double hs);
  void store_contacts(const SolverContext& context, WideRange bundles, double hs) const;
  void store_bodies(const SolverContext& context, uint32_t begin, uint32_t end) const;

  SolverIsland rest();
  SolverIsland rest_of(const Part& part);
  /// The bodies of the rest that are integrated in double precision.
  SolverIsland special();
  void read_velocities();
  void read_poses();
  void write_velocities();
  void write_poses();

  /// By body; none for padding and for the one that stands for all fixed bodies.
  std::vector<uint32_t> slots_;
  std::vector<uint32_t> local_;  ///< by body slot: index of its body here
  bool is(uint32_t slot, uint8_t flag) const { return traits_[slot].is(flag); }
  /// As in solve_island: forces act in two halves if there are only joints.
  double kick_time(double hs) const { return sort_ == WideSort::joints ? 0.5 * hs : hs; }
  bool has_joints() const { return sort_ >= WideSort::jointed; }
  std::span<const BodyTraits> traits_;  ///< by body slot
  WideSort sort_ = WideSort::plain;
  static constexpr uint8_t by_row = 1, by_bundle = 2;
  /// By body slot: whether joints of the rest or of bundles hold it.
  std::vector<uint8_t> jointed_;
  std::vector<uint8_t> bundled_;   ///< by joint: whether it may go into bundles
  std::vector<uint32_t> careful_;  ///< slots of bodies that the kernels do not integrate
  uint32_t simple_ = 0;  ///< number of bodies that the kernels integrate, a multiple of wide_lanes
  /// Index of the body that stands for all fixed ones and is used by empty lanes.
  uint32_t fixed_ = 0;
  WideRows rows_;
  std::vector<ColourEdge> edges_;
  std::vector<uint32_t> sources_;  ///< by edge: index into the contact set
  std::vector<uint8_t> counts_;    ///< by edge: number of points
  std::vector<uint8_t> turns_;     ///< by edge: Contact::resists_turning
  Colouring colouring_;
  std::vector<uint32_t> by_count_;  ///< edges in the order of the bundles
  std::vector<Bundle> bundles_;
  std::vector<WideRange> colours_;  ///< range of bundles of each colour
  JointBundles joint_bundles_;
  uint32_t bundled_points_ = 0, turning_bundles_ = 0;
  size_t points_ = 0;

  std::vector<Part> parts_;        ///< by island; empty without joints
  std::vector<uint32_t> islands_;  ///< by body: its part; none if it is in no island
  BlowBooks books_;
  std::vector<uint32_t> rest_of_;      ///< by body: its index in the rest
  std::vector<uint32_t> rest_bodies_;  ///< by index in the rest: body
  uint32_t special_ = 0;               ///< number of bodies of special(), which come first
  std::vector<SolverBody> bodies_;
  std::vector<SolverMotion> motions_;
  std::vector<ContactRow> rest_rows_;
  std::vector<PointRow> rest_points_;
  std::vector<JointBlock> joints_;
  std::vector<DriveRow> drives_;
  double kick_ = 0;  ///< time for which forces act in a sub-step before the joints are solved [s]
  Softness joint_softness_;
  std::vector<float> residuals_, joint_residuals_;  ///< by chunk of bundles
};

}  // namespace tumble
