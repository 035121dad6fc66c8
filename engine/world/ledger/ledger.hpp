#pragma once
#include "engine/core/bytes.hpp"
#include "engine/dynamics/forces/force.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace tumble {

/// A sum compensated for rounding errors (Neumaier 1974).
class CompensatedSum {
 public:
  void add(double x) {
    const double next = sum_ + x;
    lost_ += std::fabs(sum_) >= std::fabs(x) ? (sum_ - next) + x : (x - next) + sum_;
    sum_ = next;
  }
  double value() const { return sum_ + lost_; }
  void save(ByteWriter& out) const {
    out.value(sum_);
    out.value(lost_);
  }
  void load(ByteReader& in) {
    in.value(sum_);
    in.value(lost_);
  }

 private:
  double sum_ = 0, lost_ = 0;
};

/// Causes that change the energy and the momenta of a world, except forces, which have a line each.
enum class LedgerLine : uint8_t {
  gravity,        ///< uniform gravity
  restitution,    ///< contacts along their normal, and limits of joints: losses in collisions
  friction,       ///< contacts across their normal and against rotation, and friction of joints
  kinematic,      ///< moving kinematic bodies and belts
  joints,         ///< constraints of joints, their springs and dampers
  motors,         ///< of joints
  sleeping,       ///< damping and stopping of bodies that are nearly at rest
  projection,     ///< corrections of positions, and of velocities that follow from them
  offset,         ///< initial overlap that the event stepper removes over time
  sph_pressure,   ///< of fluids among themselves and on bodies, and corrections at walls
  sph_viscosity,  ///< of fluids
  sph_tension,    ///< of the surfaces of fluids
  user,           ///< the mouse, and impulses from outside
  emission,       ///< particles and bodies that emitters make
  removal,        ///< particles and bodies at the end of their life or in a sink
  edits,          ///< creation, change and removal of bodies and forces; settings
  past_forces,    ///< lines of forces that no longer exist
  integrator,     ///< what no line above explains: the error of the integrator
};
constexpr size_t ledger_lines = 18;
std::string_view ledger_line_name(LedgerLine line);

/// The effect of one cause in a tick, or since the start.
struct LedgerEntry {
  double work = 0;  ///< on the motion [J]
  /// Change of kinetic plus potential energy [J]; 0 for a force with a potential.
  double balance = 0;
  Vec3 momentum = Vec3::Zero();          ///< [kg m/s]
  Vec3 angular_momentum = Vec3::Zero();  ///< about the origin [kg m2/s]

  void add(const LedgerEntry& e) {
    work += e.work;
    balance += e.balance;
    momentum += e.momentum;
    angular_momentum += e.angular_momentum;
  }
};

/// Energy and momenta of a world at one moment.
struct LedgerState {
  double energy = 0;   ///< kinetic and potential [J]
  double kinetic = 0;  ///< [J]
  Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
};

/// One line of the ledger: the last tick, and the total since the start.
class LedgerAccount {
 public:
  LedgerEntry tick;
  LedgerEntry total() const;
  void include(const LedgerEntry& e);  ///< adds to the total
  void save(ByteWriter& out) const;
  void load(ByteReader& in);

 private:
  std::array<CompensatedSum, 8> sums_;
};

/// The line of a force, by slot.
struct ForceAccount {
  ForceId id;  ///< null: none
  LedgerAccount account;
};

/// The ledger of a world: what changed its energy and its momenta, by cause. A force with a
/// potential only converts potential into kinetic energy: its `balance` is 0. Then
///   energy now = sum of all balances since the world was empty,
/// where the integrator's line is computed as the difference that makes this hold.
class Ledger {
 public:
  /// Books a change between ticks that is not an edit: by the user, by emission, by removal. It is
  /// included in the next tick.
  void book_between(LedgerLine line, const LedgerEntry& e) { waiting(line).add(e); }
  /// Begins a tick with empty entries, except for changes booked between ticks. Any other change
  /// since the last close() goes to `edits`.
  void open(const LedgerState& now, const std::vector<std::optional<ForceDef>>& forces,
            const HandlePool<ForceTag>& ids);
  void book(LedgerLine line, const LedgerEntry& e) { entry(line).add(e); }
  void book_force(uint32_t slot, const LedgerEntry& e) { forces_[slot].account.tick.add(e); }
  /// Ends a tick: computes the integrator's line, and adds to the totals. A tick that is not closed
  /// leaves no trace.
  void close(const LedgerState& now);

  const LedgerAccount& line(LedgerLine line) const { return lines_[size_t(line)]; }
  const std::vector<ForceAccount>& forces() const { return forces_; }
  /// Sum of the absolute work of every line in every tick [J], the scale of the integrator's error.
  double throughput() const { return throughput_.value(); }
  /// |integrator's error| / throughput [-], less the rounding of the energy itself (1e-14 of it),
  /// which is all the error of a world at rest; 0 while throughput is 0.
  double drift() const;
  /// Energy and momenta at the last close(); zero for a new world.
  const LedgerState& now() const { return now_; }

  void save(ByteWriter& out) const;
  void load(ByteReader& in);

 private:
  static constexpr std::array<LedgerLine, 3> between_ticks{LedgerLine::user, LedgerLine::emission,
                                                           LedgerLine::removal};
  LedgerEntry& entry(LedgerLine line) { return lines_[size_t(line)].tick; }
  LedgerEntry& waiting(LedgerLine line);
  void retire(ForceAccount& force);
  template <class Visit>
  void for_accounts(Visit visit);

  std::array<LedgerAccount, ledger_lines> lines_;
  std::vector<ForceAccount> forces_;
  CompensatedSum throughput_;
  std::array<LedgerEntry, between_ticks.size()> waiting_;  ///< in the order of between_ticks
  LedgerState now_;
};

}  // namespace tumble
