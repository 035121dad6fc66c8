#pragma once
#include "engine/dynamics/grains/grain_field.hpp"
#include "engine/dynamics/grains/grain_report.hpp"
#include "engine/dynamics/grains/grain_rows.hpp"
#include "engine/dynamics/grains/grain_touch.hpp"
#include "engine/dynamics/grains/near_shapes.hpp"

#include <vector>

namespace tumble {

/// The bodies that grains touch: impulses between them and grains, and the rows of their contacts.
class GrainBodies {
 public:
  /// See GrainStage::carry.
  void carry(GrainTouches& touches, BodySet& bodies, const Vec3& gravity, double h);
  std::span<const GrainLoad> carried() const { return carried_; }
  void take_back(const GrainTick& tick, GrainReport& report) const;
  /// Starts a tick: no body is known yet.
  void begin_tick(const GrainTick& tick);
  /// Makes the rows of the contacts of a part; sleeping bodies wake where a grain hits them.
  void make_rows(const GrainTick& tick, const GrainField& grains, const NearShapes& shapes,
                 std::span<const NearShapes::Touch> touching, GrainReport& report);
  /// Ends a tick: sets the velocities of the bodies that grains moved.
  void give(const GrainTick& tick, GrainTouches& touches, GrainReport& report) const;
  /// Adds the effects of the rows with bodies in a part to the books.
  void count(Crew* crew, GrainReport& report) const;

  std::span<GrainBody> all() { return bodies_; }
  std::span<const GrainBody> all() const { return bodies_; }
  /// Rows with immovable bodies (walls), and with movable ones; sorted by place of the grain.
  std::span<GrainBodyRow> walls() { return walls_; }
  std::span<const GrainBodyRow> walls() const { return walls_; }
  std::span<GrainBodyRow> held() { return held_; }
  std::span<const GrainBodyRow> held() const { return held_; }

 private:
  /// Where the row of a contact is stored: among those of walls or of movable bodies.
  struct RowPlace {
    uint32_t body, index;
  };
  /// The body of a contact, as an index of all(); wakes it where the grain hits it.
  uint32_t touched_body(const GrainTick& tick, const GrainField& grains,
                        const NearShapes::Part& part, const NearShapes::Touch& touch,
                        GrainReport& report);
  GrainBodyRow row(const GrainTick& tick, const GrainField& grains, const NearShapes& shapes,
                   const NearShapes::Touch& touch, uint32_t body) const;
  template <class Add>
  static void sum_rows(Crew* crew, std::span<const GrainBodyRow> rows, GrainReport& report,
                       const Add& add);
  uint32_t body_of(const GrainTick& tick, uint32_t slot);

  std::vector<GrainBody> bodies_;
  std::vector<uint32_t> index_;  ///< by body slot: index in bodies_
  std::vector<GrainBodyRow> walls_, held_;
  std::vector<RowPlace> places_;  ///< by contact
  std::vector<GrainLoad> carried_;
};

}  // namespace tumble
