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

/// A sum that keeps what rounding takes from it (Neumaier 1974).
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

/// What changes the energy and the momenta of a world, forces apart, which have a line each.
enum class LedgerLine : uint8_t {
  gravity,        ///< uniform gravity
  restitution,    ///< contacts along their normal, and limits of joints: what collisions take
  friction,       ///< contacts across their normal and against turning, and along joints
  kinematic,      ///< moving kinematic bodies and belts
  joints,         ///< what keeps them, their springs and dampers
  motors,         ///< of joints
  sleeping,       ///< damping and stopping of what is nearly at rest
  projection,     ///< corrections of positions, and of velocities with them
  offset,         ///< overlap from before that the event stepper works off
  sph_pressure,   ///< of fluids on themselves and on bodies, and what keeps them out of walls
  sph_viscosity,  ///< of fluids
  sph_tension,    ///< of the surfaces of fluids
  user,           ///< the mouse and impulses from outside
  emission,       ///< particles and bodies that emitters make
  removal,        ///< those that reach the end of their life, or a sink
  edits,          ///< bodies and forces made, changed and removed; settings
  past_forces,    ///< lines of forces that no longer exist
  integrator,     ///< what no line above explains: the error of the integrator
};
constexpr size_t ledger_lines = 18;
std::string_view ledger_line_name(LedgerLine line);

/// What one cause did in a tick, or altogether.
struct LedgerEntry {
  double work = 0;     ///< given to the motion [J]
  double balance = 0;  ///< change of kinetic plus potential energy [J]; 0 for what has a potential
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

/// One line of the books: of the last tick, and since the beginning.
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

/// The books of a world: what changed its energy and its momenta, by cause. Forces with a potential
/// move energy between it and the motion: their `balance` is 0. Then
///   energy now = sum of all balances since the world was empty,
/// where the integrator's line is computed so that it holds, and of nothing else.
class Ledger {
 public:
  /// What happens between ticks and is not an edit: by the user, by emission, by removal. It waits
  /// for the next one.
  void book_between(LedgerLine line, const LedgerEntry& e) { waiting(line).add(e); }
  /// Empty entries for a tick, but for what waits. What else has changed since the last close()
  /// goes to `edits`.
  void open(const LedgerState& now, const std::vector<std::optional<ForceDef>>& forces,
            const HandlePool<ForceTag>& ids);
  void book(LedgerLine line, const LedgerEntry& e) { entry(line).add(e); }
  void book_force(uint32_t slot, const LedgerEntry& e) { forces_[slot].account.tick.add(e); }
  /// Ends a tick: the integrator's line, and the totals. Without it, nothing has happened.
  void close(const LedgerState& now);

  const LedgerAccount& line(LedgerLine line) const { return lines_[size_t(line)]; }
  const std::vector<ForceAccount>& forces() const { return forces_; }
  /// Sum of the absolute work of every line in every tick [J]: what the integrator's error is
  /// measured against.
  double throughput() const { return throughput_.value(); }
  /// |integrator's error| / throughput [-], but for what rounding takes from the energy itself
  /// (1e-14 of it), which is all there is of a world at rest; 0 while nothing has happened.
  double drift() const;
  /// Energy and momenta at the last close(); the world began with none.
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
