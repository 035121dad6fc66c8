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
#include "engine/dynamics/realtime/swept_pair.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct ContinuousStats {
  uint64_t fast = 0;     ///< bodies that moved farther than they foresee
  uint64_t tested = 0;   ///< pairs of shapes whose time of contact was computed
  uint64_t stopped = 0;  ///< bodies held back at a contact
  uint64_t carried = 0;  ///< bodies that a kinematic one took along from where they met
};

/// By which means the stage looks at pairs of shapes.
struct ContinuousMethods {
  NarrowPhase narrow_phase = &collide;  ///< of what overlaps
  /// Of what approaches; conservative advancement unless said otherwise, as in WorldSettings.
  TimeOfContactOptions contact_time = by_advancement();

  static TimeOfContactOptions by_advancement();
};

/// Swept detection after the solver. Bodies that moved farther in the tick, rotation included, than
/// their contacts foresee (foresight(); thin convex ones than a fiftieth of their size) are taken
/// back to just before the first contact on their way that would close deeper than the solver can
/// work off. Their velocity stays, so that the next tick resolves the contact, but for thin pairs,
/// which lose their approach. Both bodies of a pair may be fast. A kinematic body that went farther
/// than others foresee takes along what it meets, from where they meet to the end of the tick.
class ContinuousStage {
 public:
  /// Keeps the motion at the start of the tick; call before the solver. `gravity` [m/s2] lets a
  /// body that is held back in free flight keep the energy it has there. Until the next call
  /// nothing but the `involved` bodies, ascending, may change, unless `everything` may have since
  /// the last.
  void remember(std::span<const RigidBody> bodies, std::span<const uint32_t> involved,
                const Vec3& gravity = Vec3::Zero(), Crew* crew = nullptr, bool everything = true);
  /// Pairs of bodies that do not stop each other; it must live until apply().
  void pass_through(const PairFilter& apart) { apart_ = &apart; }
  /// Takes back the poses of fast bodies; call after the solver.
  ContinuousStats apply(std::span<RigidBody> bodies, BroadPhase& broad_phase, double h,
                        const RealtimeSettings& settings, Crew& crew,
                        const ContinuousMethods& methods = {});
  /// Bodies that slept in the way of a kinematic one and woke in the last apply(), ascending.
  std::span<const uint32_t> woken() const { return woken_; }
  void add_memory(MemoryUse& use) const {
    use.bodies +=
        heap_bytes(involved_, starts_, tracks_, proxies_.proxies, proxies_.refs, proxies_.first,
                   proxies_.owners, proxies_.news.moving, proxies_.news.settled, stale_, is_stale_);
    use.contacts += heap_bytes(pairs_, candidates_, in_the_way_, places_, first_of_, by_body_);
  }

 private:
  /// At the start of the tick.
  struct Start {
    Pose pose;
    Vec3 v;  ///< [m/s]
  };
  struct Track {
    Motion motion;    ///< over the tick
    double stop = 0;  ///< until when it moves [s]
    bool fast = false;
    uint32_t carrier = none;  ///< the kinematic body that it goes with since they met
  };
  struct Candidate {
    ShapeRef a, b;
    SweptStop stop;                 ///< the first that matters; beyond the tick for none
    double stop_a = 0, stop_b = 0;  ///< for which stops of the bodies it was computed
    bool thin = false;              ///< one of the shapes is: what would deepen loses its approach
    bool firm = false;  ///< and they cannot both give way: the slower must not move on either
    bool held = false;  ///< it stopped a body
  };
  /// Bounds of a body over the tick.
  struct Place {
    Aabb bounds;
    uint32_t slot;
  };
  static constexpr uint32_t none = ~uint32_t{0};
  /// Whether no body can have moved farther than it foresees, and no kinematic one farther than any
  /// other does: what is cheap to tell.
  bool all_slow(std::span<const RigidBody> bodies, double h, Crew& crew) const;
  void note_stale(size_t bodies, bool everything);
  void find_fast(std::span<const RigidBody> bodies, double h, ContinuousStats& stats);
  /// Of a shape over the tick.
  Aabb swept_bounds(const RigidBody& body, uint32_t slot, uint32_t shape) const;
  void put_proxies(const RigidBody& body, uint32_t slot);
  /// How far a shape came in the frame of another body, at most [m].
  double way_along(std::span<const RigidBody> bodies, ShapeRef ref, uint32_t carrier) const;
  /// Lists where the dynamic bodies were in the tick; sorting it makes looking for many fast.
  void list_places(std::span<const RigidBody> bodies);
  void sort_places();
  /// Lists what `carrier` may have come over.
  void find_in_the_way(std::span<const RigidBody> bodies, uint32_t carrier, bool sorted);
  void list_shapes_in_the_way(std::span<const RigidBody> bodies, uint32_t carrier, uint32_t slot);
  /// Moves what kinematic bodies meet on their way to where these take it.
  void carry_along(std::span<RigidBody> bodies, double h, Crew& crew, ContinuousStats& stats);
  void time_in_the_way(std::span<const RigidBody> bodies, double h, Crew& crew,
                       ContinuousStats& stats);
  void carry(std::span<RigidBody> bodies, const Candidate& met, double h);
  /// Stops what is carried at what gives way as little as the carrier.
  void hold_carried(std::span<RigidBody> bodies, double h, Crew& crew, ContinuousStats& stats);
  /// Whether two shapes moved relative to each other by more than their contacts foresee.
  bool far_apart(std::span<const RigidBody> bodies, ShapeRef a, ShapeRef b) const;
  void find_candidates(std::span<const RigidBody> bodies, BroadPhase& broad_phase);
  SweptPair swept_pair(std::span<const RigidBody> bodies, Candidate& candidate) const;
  void time_candidate(std::span<const RigidBody> bodies, double h, Candidate& candidate) const;
  /// Lists the candidates of every body.
  void index_candidates(size_t bodies);
  std::span<const uint32_t> candidates_of(uint32_t body) const {
    return std::span(by_body_).subspan(first_of_[body], first_of_[body + 1] - first_of_[body]);
  }
  void stop_in_order(std::span<const RigidBody> bodies, double h);
  void hold_fast(std::span<RigidBody> bodies, BroadPhase& broad_phase, double h, Crew& crew,
                 ContinuousStats& stats);
  /// Puts bodies where they stop, on the way that was looked at.
  void place(std::span<RigidBody> bodies, double h, ContinuousStats& stats) const;

  ContinuousMethods methods_;
  Vec3 gravity_ = Vec3::Zero();
  const PairFilter* apart_ = nullptr;
  std::vector<uint32_t> involved_;
  std::vector<Start> starts_;   ///< by slot, of the involved
  double least_unwatched_ = 0;  ///< of all dynamic bodies [m]
  // Where something is fast, which few ticks see; else as they were when something last was.
  std::vector<Track> tracks_;
  ProxySet proxies_;
  double h_ = 0;                   ///< of the tracks
  bool all_stale_ = true;          ///< tracks and proxies: of all bodies
  std::vector<uint32_t> stale_;    ///< or of these
  std::vector<uint8_t> is_stale_;  ///< by slot
  std::vector<ProxyPair> pairs_;
  std::vector<Candidate> candidates_;
  /// Kinematic bodies that went farther than others foresee; then what they took along.
  std::vector<uint32_t> sweeping_;
  std::vector<uint32_t> carried_;      ///< ascending
  std::vector<Candidate> in_the_way_;  ///< of these: A is the shape of the carrier
  std::vector<Aabb> ways_;             ///< of the shapes of one carrier
  std::vector<Place> places_;          ///< of dynamic bodies that nothing carries
  double widest_ = 0;                  ///< of the places, along x [m]
  std::vector<uint32_t> woken_;
  std::vector<uint32_t> first_of_, by_body_;  ///< candidates by body, ascending
};

}  // namespace tumble
