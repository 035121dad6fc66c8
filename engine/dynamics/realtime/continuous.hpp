#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/collision/motion.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/time_of_contact.hpp"
#include "engine/core/crew.hpp"
#include "engine/core/memory_use.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/pair_filter.hpp"
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/realtime/realtime_settings.hpp"
#include "engine/dynamics/realtime/stale_bodies.hpp"
#include "engine/dynamics/realtime/swept_pair.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tumble {

struct ContinuousStats {
  uint64_t fast = 0;     ///< bodies that moved farther than their foresight
  uint64_t tested = 0;   ///< pairs of shapes whose time of contact was computed
  uint64_t stopped = 0;  ///< bodies held back at a contact
  uint64_t carried = 0;  ///< bodies that were moved along with a kinematic one from where they met
};

/// The algorithms for pairs of shapes.
struct ContinuousMethods {
  NarrowPhase narrow_phase = &collide;  ///< for overlapping shapes
  /// For approaching shapes; conservative advancement by default, as in WorldSettings.
  TimeOfContactOptions contact_time = by_advancement();

  static TimeOfContactOptions by_advancement();
};

/// Continuous (swept) collision detection after the solver. A body that moved farther in the tick,
/// rotation included, than contacts are foreseen (foresight(); thin convex bodies: a fiftieth of
/// their size) is moved back to just before the first contact on its path that would overlap deeper
/// than the solver can correct. Its velocity stays, so that the next tick resolves the contact,
/// except that thin pairs lose their approach velocity. Both bodies of a pair may be fast. A
/// kinematic body that moved farther than the foresight of others moves what it meets along with
/// it, from where they meet to the end of the tick.
class ContinuousStage {
 public:
  /// Stores the motion at the start of the tick; call before the solver. `gravity` [m/s2] is used
  /// to keep the energy of a body that is stopped in free flight. Until the next call only the
  /// bodies `involved` (ascending) may change. `everything`: since the last call any body may have
  /// changed.
  void remember(std::span<const RigidBody> bodies, std::span<const uint32_t> involved,
                const Vec3& gravity = Vec3::Zero(), Crew* crew = nullptr, bool everything = true);
  /// Pairs of bodies that do not stop each other; must live until apply().
  void pass_through(const PairFilter& apart) { apart_ = &apart; }
  /// Moves fast bodies back; call after the solver. `h` is the length of the tick [s].
  ContinuousStats apply(std::span<RigidBody> bodies, BroadPhase& broad_phase, double h,
                        const RealtimeSettings& settings, Crew& crew,
                        const ContinuousMethods& methods = {});
  /// Bodies that a kinematic one met while they slept, and that woke in the last apply(),
  /// ascending.
  std::span<const uint32_t> woken() const { return woken_; }
  /// Bodies that kinematic ones carried along in the last apply(), ascending, the woken among them;
  /// where each was at the start of the tick.
  std::span<const uint32_t> carried() const { return carried_; }
  const Pose& start_of(uint32_t body) const { return starts_[body].pose; }
  void add_memory(MemoryUse& use) const {
    use.bodies +=
        heap_bytes(involved_, starts_, tracks_, proxies_.proxies, proxies_.refs, proxies_.first,
                   proxies_.owners, proxies_.news.moving, proxies_.news.settled) +
        stale_tracks_.bytes() + stale_proxies_.bytes();
    use.contacts += heap_bytes(pairs_, candidates_, in_the_way_, places_, first_of_, by_body_);
  }

 private:
  /// State at the start of the tick.
  struct Start {
    Pose pose;
    Vec3 v;  ///< [m/s]
  };
  struct Track {
    Motion motion;    ///< over the tick
    double stop = 0;  ///< time until which it moves, since the start of the tick [s]
    bool fast = false;
    uint32_t carrier = none;  ///< the kinematic body that it has moved with since they met
  };
  struct Candidate {
    ShapeRef a, b;
    SweptStop stop;  ///< the first time at which the pair must be stopped; beyond the tick if never
    double stop_a = 0, stop_b = 0;  ///< the stops of the two bodies for which it was computed
    bool thin = false;  ///< a shape is thin: a pair that would overlap deeper loses its approach
    bool firm = false;  ///< thin, and not both can give way: the slower body is stopped too
    bool held = false;  ///< it has stopped a body
    double reach = std::numeric_limits<double>::infinity();  ///< SweptPair::reach [m]
  };
  /// Bounds of a dynamic body over the tick.
  struct Place {
    Aabb bounds;
    uint32_t slot;
  };
  static constexpr uint32_t none = ~uint32_t{0};
  /// A cheap sufficient test that no body moved farther than its foresight, and no kinematic body
  /// farther than that of any other.
  bool all_slow(std::span<const RigidBody> bodies, double h, Crew& crew) const;
  void find_fast(std::span<const RigidBody> bodies, double h, ContinuousStats& stats);
  /// Bounds of a shape over the tick.
  Aabb swept_bounds(const RigidBody& body, uint32_t slot, uint32_t shape) const;
  void put_proxies(const RigidBody& body, uint32_t slot);
  /// Upper bound on how far a shape moved in the frame of another body [m].
  double way_along(std::span<const RigidBody> bodies, ShapeRef ref, uint32_t carrier) const;
  /// Lists the bounds of dynamic bodies over the tick; sorted, they are searched faster for many
  /// carriers.
  void list_places(std::span<const RigidBody> bodies);
  void sort_places();
  /// Of sorted places, those that may reach beyond x [m].
  std::span<const Place> places_from(double x) const;
  /// Lists pairs of shapes of `carrier` and of bodies that it may have swept over.
  void find_in_the_way(std::span<const RigidBody> bodies, uint32_t carrier, bool sorted);
  void list_shapes_in_the_way(std::span<const RigidBody> bodies, uint32_t carrier, uint32_t slot);
  /// Moves bodies that kinematic bodies meet along with these.
  void carry_along(std::span<RigidBody> bodies, double h, Crew& crew, ContinuousStats& stats);
  void time_in_the_way(std::span<const RigidBody> bodies, double h, Crew& crew,
                       ContinuousStats& stats);
  void carry(std::span<RigidBody> bodies, const Candidate& met, double h);
  /// Stops carried bodies at fixed and other kinematic bodies.
  void hold_carried(std::span<RigidBody> bodies, double h, Crew& crew, ContinuousStats& stats);
  /// Whether two shapes moved farther relative to each other than contacts are foreseen.
  bool far_apart(std::span<const RigidBody> bodies, ShapeRef a, ShapeRef b) const;
  void find_candidates(std::span<const RigidBody> bodies, BroadPhase& broad_phase);
  SweptPair swept_pair(std::span<const RigidBody> bodies, Candidate& candidate) const;
  void time_candidate(std::span<const RigidBody> bodies, double h, Candidate& candidate) const;
  /// Lists the candidates by body.
  void index_candidates(size_t bodies);
  std::span<const uint32_t> candidates_of(uint32_t body) const {
    return std::span(by_body_).subspan(first_of_[body], first_of_[body + 1] - first_of_[body]);
  }
  void stop_in_order(std::span<const RigidBody> bodies, double h);
  void hold_fast(std::span<RigidBody> bodies, BroadPhase& broad_phase, double h, Crew& crew,
                 ContinuousStats& stats);
  /// Puts bodies where they stop, on the path that was tested.
  void place(std::span<RigidBody> bodies, double h, ContinuousStats& stats) const;

  ContinuousMethods methods_;
  Vec3 gravity_ = Vec3::Zero();
  const PairFilter* apart_ = nullptr;
  std::vector<uint32_t> involved_;
  std::vector<Start> starts_;   ///< by slot; of the involved bodies
  double least_unwatched_ = 0;  ///< least unwatched() distance of all dynamic bodies [m]
  // Only brought up to date in ticks in which they are needed, which are few.
  std::vector<Track> tracks_;
  ProxySet proxies_;
  StaleBodies stale_tracks_, stale_proxies_;
  double h_ = 0;  ///< length of the tick of the tracks [s]
  std::vector<ProxyPair> pairs_;
  std::vector<Candidate> candidates_;
  /// Kinematic bodies that moved farther than the foresight of others; later, the bodies that they
  /// carried.
  std::vector<uint32_t> sweeping_;
  std::vector<uint32_t> carried_;  ///< bodies that were carried, ascending
  /// Pairs of shapes for one step of carry_along; A belongs to the carrier.
  std::vector<Candidate> in_the_way_;
  std::vector<Aabb> ways_;     ///< bounds of the shapes of one carrier over the tick
  std::vector<Place> places_;  ///< of dynamic bodies that are not carried
  double widest_ = 0;          ///< greatest extent of a place along x [m]
  std::vector<uint32_t> woken_;
  std::vector<uint32_t> first_of_, by_body_;  ///< indices of candidates by body, ascending
};

}  // namespace tumble
