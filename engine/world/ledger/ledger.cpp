#include "engine/world/ledger/ledger.hpp"

#include "engine/world/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

std::array<double, 8> numbers_of(const LedgerEntry& e) {
  return {e.work,
          e.balance,
          e.momentum.x(),
          e.momentum.y(),
          e.momentum.z(),
          e.angular_momentum.x(),
          e.angular_momentum.y(),
          e.angular_momentum.z()};
}

LedgerEntry load_entry(ByteReader& in) {
  std::array<double, 8> v{};
  for (double& x : v) in.value(x);
  return {v[0], v[1], Vec3(v[2], v[3], v[4]), Vec3(v[5], v[6], v[7])};
}

void save_ledger_state(ByteWriter& out, const LedgerState& s) {
  out.value(s.energy);
  out.value(s.kinetic);
  out.value(s.momentum);
  out.value(s.angular_momentum);
}

void load_ledger_state(ByteReader& in, LedgerState& s) {
  in.value(s.energy);
  in.value(s.kinetic);
  in.value(s.momentum);
  in.value(s.angular_momentum);
}

/// The change from one state to another.
LedgerEntry change(const LedgerState& from, const LedgerState& to) {
  return {to.kinetic - from.kinetic, to.energy - from.energy, to.momentum - from.momentum,
          to.angular_momentum - from.angular_momentum};
}

LedgerEntry without(LedgerEntry all, const LedgerEntry& part) {
  all.work -= part.work;
  all.balance -= part.balance;
  all.momentum -= part.momentum;
  all.angular_momentum -= part.angular_momentum;
  return all;
}

}  // namespace

std::string_view ledger_line_name(LedgerLine line) {
  static constexpr std::array<std::string_view, ledger_lines> names{
      "gravity",  "restitution", "friction", "kinematic",    "joints",        "motors",
      "sleeping", "projection",  "offset",   "sph_pressure", "sph_viscosity", "sph_tension",
      "user",     "emission",    "removal",  "edits",        "past_forces",   "integrator"};
  return names[size_t(line)];
}

LedgerEntry& Ledger::waiting(LedgerLine line) {
  const auto at = std::ranges::find(between_ticks, line);
  return waiting_[size_t(at - between_ticks.begin())];
}

LedgerEntry LedgerAccount::total() const {
  const auto v = [this](size_t i) { return sums_[i].value(); };
  return {v(0), v(1), Vec3(v(2), v(3), v(4)), Vec3(v(5), v(6), v(7))};
}

void LedgerAccount::include(const LedgerEntry& e) {
  const auto values = numbers_of(e);
  for (size_t i = 0; i < values.size(); ++i) sums_[i].add(values[i]);
}

void LedgerAccount::save(ByteWriter& out) const {
  for (const double v : numbers_of(tick)) out.value(v);
  for (const CompensatedSum& s : sums_) s.save(out);
}

void LedgerAccount::load(ByteReader& in) {
  tick = load_entry(in);
  for (CompensatedSum& s : sums_) s.load(in);
}

template <class Visit>
void Ledger::for_accounts(Visit visit) {
  for (LedgerAccount& a : lines_) visit(a);
  for (ForceAccount& f : forces_) visit(f.account);
}

/// Adds the line of a force that no longer exists to the common line of all such forces.
void Ledger::retire(ForceAccount& force) {
  if (!force.id.is_null()) lines_[size_t(LedgerLine::past_forces)].include(force.account.total());
  force = {};
}

void Ledger::open(const LedgerState& now, const std::vector<std::optional<ForceDef>>& forces,
                  const HandlePool<ForceTag>& ids) {
  for_accounts([](LedgerAccount& a) { a.tick = {}; });
  entry(LedgerLine::edits) = change(now_, now);
  for (const LedgerLine line : between_ticks) {
    entry(line) = waiting(line);
    entry(LedgerLine::edits) = without(entry(LedgerLine::edits), waiting(line));
  }
  for (size_t i = forces.size(); i < forces_.size(); ++i) retire(forces_[i]);
  forces_.resize(forces.size());
  for (uint32_t i = 0; i < forces.size(); ++i) {
    const ForceId id = forces[i] ? ids.at(i) : ForceId{};
    if (forces_[i].id != id) retire(forces_[i]);
    forces_[i].id = id;
  }
}

void Ledger::close(const LedgerState& now) {
  LedgerEntry explained;
  for_accounts([&](const LedgerAccount& a) { explained.add(a.tick); });
  entry(LedgerLine::integrator) = without(change(now_, now), explained);
  now_ = now;
  waiting_.fill({});
  for_accounts([&](LedgerAccount& a) {
    a.include(a.tick);
    throughput_.add(std::fabs(a.tick.work));
  });
}

double Ledger::drift() const {
  const double all = throughput();
  const double error = std::fabs(line(LedgerLine::integrator).total().balance);
  const double rounding = tolerances::energy_digits * std::fabs(now_.energy);
  return all > 0 && error > rounding ? (error - rounding) / all : 0;
}

void Ledger::save(ByteWriter& out) const {
  for (const LedgerAccount& a : lines_) a.save(out);
  out.value(uint64_t(forces_.size()));
  for (const ForceAccount& f : forces_) {
    out.value(f.id);
    f.account.save(out);
  }
  throughput_.save(out);
  for (const LedgerEntry& e : waiting_)
    for (const double v : numbers_of(e)) out.value(v);
  save_ledger_state(out, now_);
}

void Ledger::load(ByteReader& in) {
  for (LedgerAccount& a : lines_) a.load(in);
  forces_.clear();
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    ForceAccount& f = forces_.emplace_back();
    in.value(f.id);
    f.account.load(in);
  }
  throughput_.load(in);
  for (LedgerEntry& e : waiting_) e = load_entry(in);
  load_ledger_state(in, now_);
}

}  // namespace tumble
