#include "engine/scene/build/coupling_faults.hpp"

#include "engine/math/time_course.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Ratios and offsets that differ by less, relative to the numbers they are computed from, count as
/// equal [-].
constexpr double same_number = 1e-9;
/// Times at which the rates of motors with courses are compared [s].
constexpr double looks_at_motors[] = {0, 0.1, 0.37, 1, 3, 10};

/// A coordinate of a joint.
struct Place {
  uint32_t joint = 0, coordinate = 0;
  auto operator<=>(const Place&) const = default;
};

/// x = ratio y + offset.
struct Line {
  double ratio = 1, offset = 0;
  double size = 0;  ///< magnitude of the numbers whose sum is the offset

  /// The composition with y = of(z).
  Line after(const Line& of) const {
    return {ratio * of.ratio, ratio * of.offset + offset,
            std::fabs(ratio) * (of.size + std::fabs(of.offset)) + size + std::fabs(offset)};
  }
  bool changes_rate() const { return std::fabs(ratio - 1) > same_number; }
  bool shifts() const { return std::fabs(offset) > same_number * (1 + size); }
};

bool same_rate(double a, double b) {
  return std::fabs(a - b) <= same_number * (1 + std::fabs(a) + std::fabs(b));
}

/// Every coordinate follows at most one other, so couplings form chains, which end or run into a
/// cycle.
class Couplings {
 public:
  explicit Couplings(const BuiltScene& built) {
    for (const auto& [name, id] : built.joints) {
      const JointDef* def = built.world->joint(id);
      if (!def) continue;
      joints_[id.index] = {name, def};
      for (uint32_t k = 0; k < most_coordinates; ++k) {
        const auto& couple = def->drives[k].couple;
        if (!couple) continue;
        const uint32_t leader = couple->joint.is_null() ? id.index : couple->joint.index;
        follows_[{id.index, k}] = {{leader, couple->coordinate}, {couple->ratio, couple->offset}};
      }
    }
  }

  std::vector<std::pair<std::string, std::string>> faults() {
    for (const auto& [place, follow] : follows_) look_at_circle(place);
    for (const auto& [index, joint] : joints_)
      for (uint32_t k = 0; k < most_coordinates; ++k)
        if (joint.def->drives[k].motor.holds_rate_with_any_force()) look_at_motor({index, k});
    return std::move(out_);
  }

 private:
  struct Named {
    std::string name;
    const JointDef* def = nullptr;
  };
  struct Follow {
    Place leader;
    Line line;
  };

  std::string name_of(const Place& p) const {
    const Named& joint = joints_.at(p.joint);
    const auto& all = entry_of(joint.def->kind).coordinates;
    return all.size() == 1 ? joint.name : fmt::format("{}.{}", joint.name, all[p.coordinate].name);
  }
  bool angle(const Place& p) const {
    return entry_of(joints_.at(p.joint).def->kind).coordinates[p.coordinate].angle;
  }
  std::string value_text(const Place& p, double value) const {
    return angle(p) ? fmt::format("{:.6g} deg", value * 180 / std::numbers::pi)
                    : fmt::format("{:.6g} m", value);
  }
  std::string rate_text(const Place& p, double rate) const {
    return fmt::format("{:.6g} {}", rate, angle(p) ? "rad/s" : "m/s");
  }
  void fault(const Place& p, std::string sentence) {
    out_.emplace_back("joints." + name_of(p), std::move(sentence));
  }

  /// Reports a cycle, at its first coordinate.
  void look_at_circle(const Place& first) {
    Line line{1, 0};
    std::string round;
    Place p = first;
    size_t length = 0;
    for (bool back = false; !back; back = p == first) {
      const auto follow = follows_.find(p);
      if (follow == follows_.end() || p < first || ++length > follows_.size()) return;
      line = line.after(follow->second.line);
      p = follow->second.leader;
      round += fmt::format("{}'{}'", length == 1 ? "" : ", ", name_of(p));
    }
    if (length > most_named) round = fmt::format("{} others", length - 1);
    const std::string added = line.shifts() ? (line.offset < 0 ? " - " : " + ") +
                                                  value_text(first, std::fabs(line.offset))
                                            : std::string();
    if (line.changes_rate())
      fault(first,
            fmt::format("is coupled to itself (through {}) by x = {:.6g} x{}, which only {} "
                        "fulfils: nothing there could move (let the ratios round the circle "
                        "multiply to 1, or leave one couple out)",
                        round, line.ratio, added,
                        value_text(first, line.shifts() ? line.offset / (1 - line.ratio) : 0)));
    else if (line.shifts())
      fault(first, fmt::format("is coupled to itself (through {}) by x = x{}, which nothing "
                               "fulfils (let the offsets round the circle add up to nothing, or "
                               "leave one couple out)",
                               round, added));
  }

  /// The end of a chain, or the first coordinate of its cycle, with the ratio to it.
  std::pair<Place, double> leader_of(const Place& of) const {
    Place p = of;
    double ratio = 1;
    std::vector<std::pair<Place, double>> passed;
    for (;;) {
      const auto again = std::ranges::find(passed, p, &std::pair<Place, double>::first);
      if (again != passed.end()) return *std::min_element(again, passed.end());
      passed.emplace_back(p, ratio);
      const auto follow = follows_.find(p);
      if (follow == follows_.end()) return passed.back();
      ratio *= follow->second.line.ratio;
      p = follow->second.leader;
    }
  }

  double rate_of_motor(const Place& p, double t) const {
    const CoordinateMotor& m = joints_.at(p.joint).def->drives[p.coordinate].motor;
    return m.course ? m.course->at(t) : m.target;
  }

  void look_at_motor(const Place& p) {
    const auto [leader, ratio] = leader_of(p);
    const auto leads = ratio == 0 ? motors_.end() : motors_.try_emplace(leader, p, ratio).first;
    for (const double t : looks_at_motors) {
      const double rate = rate_of_motor(p, t);
      if (leads == motors_.end()) {
        if (rate == 0 || !std::isfinite(rate)) continue;
        return fault(p, fmt::format("its motor holds {}, but what it follows by a ratio of 0 lets "
                                    "it stand (give the motor a max_force, or leave one out)",
                                    rate_text(p, rate)));
      }
      const auto& [other, other_ratio] = leads->second;
      const double asked = rate_of_motor(other, t) * ratio / other_ratio;
      if (same_rate(rate, asked) || !std::isfinite(rate - asked)) continue;
      return fault(p, fmt::format("its motor holds {}, but the couplings and the motor at '{}', "
                                  "which holds {}, ask for {}: no motion fulfils both (give one of "
                                  "the motors a max_force, or leave one out)",
                                  rate_text(p, rate), name_of(other),
                                  rate_text(other, rate_of_motor(other, t)), rate_text(p, asked)));
    }
  }

  static constexpr size_t most_named = 6;  ///< coordinates of a cycle that are named
  std::map<uint32_t, Named> joints_;
  std::map<Place, Follow> follows_;
  std::map<Place, std::pair<Place, double>> motors_;  ///< one for each leader, with its ratio
  std::vector<std::pair<std::string, std::string>> out_;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> coupling_faults(const BuiltScene& built) {
  if (!built.world) return {};
  return Couplings(built).faults();
}

}  // namespace tumble
