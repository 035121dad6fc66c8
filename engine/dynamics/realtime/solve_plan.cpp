#include "engine/dynamics/realtime/solve_plan.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tumble {
namespace {

uint8_t flags_of(const RigidBody& body, double h) {
  if (body.type == BodyType::fixed) return 0;
  const bool spins = turns_fast(body, h);
  if (!body.dynamic()) return uint8_t(BodyTraits::kinematic | (spins ? BodyTraits::fast : 0));
  if (body.asleep) return 0;
  const bool slender = slender_inertia(body.inertia_body).has_value();
  uint8_t flags = BodyTraits::dynamic;
  if (body.precise) flags |= BodyTraits::precise;
  if (spins || slender) flags |= BodyTraits::fast;
  if (slender || (spins && !isotropic_inertia(body.inertia_body))) flags |= BodyTraits::careful;
  return flags;
}

/// Size of an island: contact points plus twice the joints.
size_t work_of(const Island& island) {
  return island.points + 2 * size_t(island.joint_end - island.joint_begin);
}

}  // namespace

int precise_substeps(size_t work, const RealtimeSettings& settings) {
  const int most = std::max(settings.substeps, settings.max_substeps);
  const size_t affordable = tolerances::precise_budget / std::max<size_t>(work, 1);
  return int(std::clamp(affordable, size_t(settings.substeps), size_t(most)));
}

int precise_joint_sweeps(size_t joints) {
  return int(std::clamp(tolerances::joint_budget / std::max<size_t>(joints, 1), size_t{1},
                        tolerances::most_joint_sweeps));
}

bool turns_arms(const Contact& contact, bool of_a) {
  const double rounding = of_a ? contact.rounding_a : contact.rounding_b;
  return std::ranges::any_of(contact.used(), [&](const ContactPoint& p) {
    return (of_a ? p.anchor_a : p.anchor_b).norm() > rounding * (1 + tolerances::on_round_surface);
  });
}

void SolvePlans::read_bodies(const SolverContext& c, const IslandSet& islands, Crew& crew) {
  traits_.resize(c.bodies.size());
  const std::span<const uint32_t> involved = islands.involved;
  const double g = c.gravity.norm();
  for_chunks(&crew, involved.size(), [&](size_t, size_t first, size_t last) {
    for (const uint32_t i : involved.subspan(first, last - first)) {
      const RigidBody& body = c.bodies[i];
      traits_[i] = {flags_of(body, c.h), 0, float(body.mass), float(body.inner_radius),
                    float(g * std::abs(body.gravity_scale))};
    }
  });
}

/// Whether a contact yields too much in ordinary sub-steps.
bool SolvePlans::sinks(const IslandSet& islands, const Island& island, double substep) const {
  for (uint32_t k = island.contact_begin; k < island.contact_end; ++k) {
    const IslandSet::Ends& ends = islands.ends[islands.contacts[k]];
    const BodyTraits &a = traits_[ends.a], &b = traits_[ends.b];
    double ratio = 1, pull = 0, radius = std::numeric_limits<double>::infinity();
    if (a.is(BodyTraits::dynamic) && b.is(BodyTraits::dynamic))
      ratio = double(std::max(a.mass, b.mass)) / double(std::min(a.mass, b.mass));
    for (const BodyTraits* t : {&a, &b}) {
      if (!t->is(BodyTraits::dynamic)) continue;
      pull = std::max(pull, double(t->pull));
      radius = std::min(radius, double(t->inner_radius));
    }
    // Without weight nothing sinks, and impacts decide: precise.
    if (!(pull > 0) || ratio * pull * substep * substep > tolerances::allowed_sink * radius)
      return true;
  }
  return false;
}

bool SolvePlans::hangs_heavily(const SolverContext& c, const IslandSet& islands,
                               const Island& island) const {
  const auto mass = [&](uint32_t slot) { return slot == no_body ? 0 : traits_[slot].mass; };
  for (uint32_t k = island.joint_begin; k < island.joint_end; ++k) {
    const Joint& joint = c.joints[islands.joints[k]];
    const double a = mass(joint.a), b = mass(joint.b);
    if (a > 0 && b > 0 && std::max(a, b) > tolerances::borne_mass_ratio * std::min(a, b))
      return true;
  }
  return false;
}

/// Sub-steps for an island with springs, by its speeds and the stiffness of its springs.
int SolvePlans::spring_substeps(const SolverContext& c, const IslandSet& islands,
                                const Island& island) const {
  double speed = 0, shortest = std::numeric_limits<double>::infinity(), stiffest = 0;
  for (const uint32_t k : springs(uint32_t(&island - islands.islands.data()))) {
    const SolvedSpring& spring = c.springs[k];
    const SpringMotion motion = spring_motion(spring, c.bodies);
    stiffest = std::max(stiffest, spring.stiffness * motion.mobility);
    if (spring.rest_length == 0) continue;  // resists bending, or has no length at rest
    speed = std::max(speed, motion.rate.norm());
    shortest = std::min(shortest, spring.rest_length);
  }
  for (uint32_t k = island.contact_begin; k < island.contact_end; ++k) {
    const IslandSet::Ends& ends = islands.ends[islands.contacts[k]];
    speed = std::max(speed, (c.bodies[ends.b].v - c.bodies[ends.a].v).norm());
  }
  const double needed = std::max(speed / (tolerances::passed_in_substep * shortest),
                                 std::sqrt(stiffest) / tolerances::stiff_in_substep);
  const double wanted = std::max(1 / tolerances::spring_substep, needed);
  return int(std::ceil(std::min(
      c.h * wanted, std::max(c.h / tolerances::spring_substep, tolerances::most_spring_substeps))));
}

WideSort SolvePlans::sort(const SolverContext& c, const IslandSet& islands, const Island& island) {
  const auto contacts =
      std::span(islands.contacts)
          .subspan(island.contact_begin, island.contact_end - island.contact_begin);
  if (island.joint_begin < island.joint_end) {
    if (contacts.empty()) return WideSort::joints;
    const bool bounces =
        std::ranges::any_of(contacts, [&](uint32_t k) { return islands.ends[k].bounces; });
    return bounces ? WideSort::jointed_bouncing : WideSort::jointed;
  }
  bool plain = true;
  for (uint32_t k = island.body_begin; k < island.body_end && plain; ++k)
    plain = !traits_[islands.bodies[k]].is(BodyTraits::careful);
  for (size_t i = 0; i < contacts.size() && plain; ++i) {
    const IslandSet::Ends& ends = islands.ends[contacts[i]];
    BodyTraits &a = traits_[ends.a], &b = traits_[ends.b];
    plain = !a.is(BodyTraits::kinematic) && !b.is(BodyTraits::kinematic);
    for (BodyTraits* t : {&a, &b})
      if (t->is(BodyTraits::dynamic))
        plain = plain && ++t->contacts <= tolerances::coloured_contacts;
    if (a.is(BodyTraits::fast)) plain = plain && !turns_arms(c.contacts[contacts[i]], true);
    if (b.is(BodyTraits::fast)) plain = plain && !turns_arms(c.contacts[contacts[i]], false);
  }
  return plain ? WideSort::plain : WideSort::contacts;
}

SolvePlan SolvePlans::plan(const SolverContext& c, const IslandSet& islands, const Island& island) {
  const RealtimeSettings& s = *c.settings;
  const size_t work = work_of(island), joints = island.joint_end - island.joint_begin;
  SolvePlan plan;
  plan.substeps = s.substeps;
  const auto index = uint32_t(&island - islands.islands.data());
  if (!springs(index).empty()) {
    plan.substeps = std::max(s.substeps, spring_substeps(c, islands, island));
    plan.joint_sweeps = precise_joint_sweeps(joints);
    return plan;
  }
  if (work == 0) return plan;
  const int most = precise_substeps(work, s);
  const auto asked = [&] {
    return s.precise || std::any_of(islands.bodies.begin() + island.body_begin,
                                    islands.bodies.begin() + island.body_end, [&](uint32_t slot) {
                                      return traits_[slot].is(BodyTraits::precise);
                                    });
  };
  const bool precise =
      !couplings(index).empty() ||
      (most > s.substeps && (work <= tolerances::negligible_work || asked() ||
                             (joints == 0 ? sinks(islands, island, c.h / s.substeps)
                                          : hangs_heavily(c, islands, island))));
  if (precise) {
    plan.substeps = most;
    plan.joint_sweeps = precise_joint_sweeps(joints);
    return plan;
  }
  plan.joint_sweeps = tolerances::ordinary_joint_sweeps;
  plan.wide = true;
  plan.sort = sort(c, islands, island);
  return plan;
}

std::span<const uint32_t> SolvePlans::ByIsland::of(uint32_t island) const {
  if (things_.empty()) return {};
  return std::span(things_).subspan(first_[island], first_[island + 1] - first_[island]);
}

template <class F>
void SolvePlans::ByIsland::sort(const IslandSet& islands, size_t count, const F& slot_of) {
  things_.clear();
  if (count == 0) return;
  std::vector<uint32_t> of(count);
  first_.assign(islands.islands.size() + 1, 0);
  for (size_t k = 0; k < count; ++k) {
    const uint32_t slot = slot_of(k);
    of[k] = slot == no_body ? 0 : islands.island_of[slot];
    if (of[k] > 0) ++first_[of[k]];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  things_.resize(first_.back());
  std::vector<uint32_t> next = first_;
  for (size_t k = 0; k < count; ++k)
    if (of[k] > 0) things_[next[of[k] - 1]++] = uint32_t(k);
}

void SolvePlans::make(const SolverContext& c, const IslandSet& islands, Crew& crew) {
  read_bodies(c, islands, crew);
  // Each belongs to the island of its first body that is in any: links made its bodies one island.
  const auto in_island = [&](uint32_t slot) {
    return slot != no_body && islands.island_of[slot] != 0;
  };
  couplings_.sort(islands, c.couplings.size(),
                  [&](size_t k) { return first_body(c.couplings[k], c.joints, in_island); });
  springs_.sort(islands, c.springs.size(), [&](size_t k) {
    const SolvedSpring& spring = c.springs[k];
    for (uint32_t i = 0; i < spring.count; ++i)
      if (in_island(spring.end[i].slot)) return spring.end[i].slot;
    return no_body;
  });
  plans_.clear();
  for (auto& which : wide_) which.clear();
  for (uint32_t i = 0; i < islands.islands.size(); ++i) {
    plans_.push_back(plan(c, islands, islands.islands[i]));
    if (plans_.back().wide) wide_[size_t(plans_.back().sort)].push_back(i);
  }
}

}  // namespace tumble
