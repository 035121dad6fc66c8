// Assigns bodies, contacts and joints to the arrays.
#include "engine/dynamics/realtime/solve_joints.hpp"
#include "engine/dynamics/realtime/wide/wide_island.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

constexpr uint32_t no_place = ~uint32_t{0};

}  // namespace

void WideIsland::clear(const SolverContext& c, std::span<const uint32_t> involved) {
  slots_.clear();
  local_.resize(c.bodies.size());
  jointed_.resize(c.bodies.size());
  for (const uint32_t slot : involved) local_[slot] = no_place, jointed_[slot] = 0;
  bundled_.resize(c.joints.size());
  edges_.clear();
  sources_.clear();
  counts_.clear();
  turns_.clear();
  by_count_.clear();
  bundles_.clear();
  bundled_points_ = turning_bundles_ = 0;
  colours_.clear();
  rest_bodies_.clear();
  rest_rows_.clear();
  rest_points_.clear();
  joints_.clear();
  drives_.clear();
  joint_bundles_.clear();
  simple_ = special_ = fixed_ = 0;
  points_ = 0;
}

uint32_t WideIsland::add_body(uint32_t slot) {
  if (slot != no_place) local_[slot] = uint32_t(slots_.size());
  slots_.push_back(slot);
  return uint32_t(slots_.size() - 1);
}

/// Adds the bodies that the kernels integrate, then those that need double precision, then the one
/// for fixed bodies.
void WideIsland::add_bodies(const SolverContext& c, const IslandSet& islands,
                            std::span<const uint32_t> which) {
  careful_.clear();
  for (const uint32_t k : which) {
    const Island& island = islands.islands[k];
    for (uint32_t i = island.joint_begin; i < island.joint_end; ++i) {
      const Joint& joint = c.joints[islands.joints[i]];
      bundled_[islands.joints[i]] = JointBundles::takes(joint, c.bodies);
      const uint8_t how = bundled_[islands.joints[i]] ? by_bundle : by_row;
      for (const uint32_t end : {joint.a, joint.b})
        if (end != no_body) jointed_[end] = uint8_t(jointed_[end] | how);
    }
    for (uint32_t i = island.body_begin; i < island.body_end; ++i) {
      const uint32_t slot = islands.bodies[i];
      if ((jointed_[slot] & by_row) || is(slot, BodyTraits::careful)) {
        careful_.push_back(slot);
      } else {
        add_body(slot);
      }
    }
  }
  while (slots_.size() % wide_lanes != 0) add_body(no_place);
  simple_ = uint32_t(slots_.size());
  for (const uint32_t slot : careful_) add_body(slot);
  fixed_ = add_body(no_place);
}

uint32_t WideIsland::find(uint32_t slot) {
  if (slot == no_body || !is(slot, BodyTraits::dynamic | BodyTraits::kinematic)) return fixed_;
  // kinematic body that occurs for the first time
  return local_[slot] != no_place ? local_[slot] : add_body(slot);
}

uint32_t WideIsland::in_rest(uint32_t body) {
  if (rest_of_.size() <= body) rest_of_.resize(slots_.size(), no_place);
  if (rest_of_[body] == no_place) {
    rest_of_[body] = uint32_t(rest_bodies_.size());
    rest_bodies_.push_back(body);
  }
  return rest_of_[body];
}

void WideIsland::add_contact(const SolverContext& c, const IslandSet& islands, uint32_t source) {
  const auto [a, b, points, bounces, resists_turning] = islands.ends[source];
  if ((is(a, BodyTraits::fast) && turns_arms(c.contacts[source], true)) ||
      (is(b, BodyTraits::fast) && turns_arms(c.contacts[source], false))) {
    add_rest_row(source, islands.ends[source]);
    return;
  }
  const auto end = [&](uint32_t slot) {
    return is(slot, BodyTraits::dynamic) ? find(slot) : ColourEdge::fixed;
  };
  edges_.push_back({end(a), end(b)});
  sources_.push_back(source);
  counts_.push_back(uint8_t(points));
  turns_.push_back(resists_turning);
}

void WideIsland::add_rest_row(uint32_t source, const IslandSet::Ends& ends) {
  ContactRow& row = rest_rows_.emplace_back();
  row.source = source;
  row.a = in_rest(find(ends.a));
  row.b = in_rest(find(ends.b));
  row.first = uint32_t(rest_points_.size());
  row.count = ends.points;
  rest_points_.resize(rest_points_.size() + ends.points);
}

void WideIsland::add_joint(const SolverContext& c, uint32_t source) {
  const Joint& joint = c.joints[source];
  if (bundled_[source]) {
    joint_bundles_.add(c, source, find(joint.a), find(joint.b));
  } else {
    add_rest_joint(c, source);
  }
}

void WideIsland::add_rest_joint(const SolverContext& c, uint32_t source) {
  const Joint& from = c.joints[source];
  JointBlock& joint = joints_.emplace_back();
  joint.source = source;
  joint.a = in_rest(find(from.a));
  joint.b = in_rest(find(from.b));
  add_drives(from, 0, joint, drives_);
}

void WideIsland::lay_out(const SolverContext& c, const IslandSet& islands,
                         std::span<const uint32_t> which, std::span<const BodyTraits> traits,
                         WideSort sort, Crew&) {
  clear(c, islands.involved);
  traits_ = traits;
  sort_ = sort;
  if (which.empty()) return;
  add_bodies(c, islands, which);
  rest_of_.assign(slots_.size(), no_place);
  // Bodies that are integrated in double precision come first in the rest: those that need care,
  // and kinematic bodies, which are found by the contacts and joints below.
  for (uint32_t k = simple_; k < fixed_; ++k) in_rest(k);
  for (const uint32_t k : which) {
    const Island& island = islands.islands[k];
    for (uint32_t i = island.contact_begin; i < island.contact_end; ++i) {
      const IslandSet::Ends& ends = islands.ends[islands.contacts[i]];
      for (const uint32_t slot : {ends.a, ends.b})
        if (is(slot, BodyTraits::kinematic)) in_rest(find(slot));
    }
    for (uint32_t i = island.joint_begin; i < island.joint_end; ++i) {
      const Joint& joint = c.joints[islands.joints[i]];
      for (const uint32_t slot : {joint.a, joint.b})
        if (slot != no_body && (is(slot, BodyTraits::kinematic))) in_rest(find(slot));
    }
  }
  special_ = uint32_t(rest_bodies_.size());
  for (const uint32_t k : which) {
    const Island& island = islands.islands[k];
    for (uint32_t i = island.contact_begin; i < island.contact_end; ++i)
      add_contact(c, islands, islands.contacts[i]);
    points_ += island.points;
    for (uint32_t i = island.joint_begin; i < island.joint_end; ++i)
      add_joint(c, islands.joints[i]);
  }
  colouring_.assign(edges_, uint32_t(slots_.size()));
  for (const uint32_t edge : colouring_.left_over())
    add_rest_row(sources_[edge], islands.ends[sources_[edge]]);
  for (const uint32_t joint : joint_bundles_.bundle(c, uint32_t(slots_.size())))
    add_rest_joint(c, joint);
  part(islands, which);
  bundle();
}

/// Sets the range of each island in the rest, whose rows are in the order of islands except for
/// those without a colour.
template <class Row>
void WideIsland::part_rest(std::vector<Row>& rows, WideRange Part::*range) {
  const auto of = [this](const Row& row) {
    return part_of(rest_bodies_[row.a], rest_bodies_[row.b]);
  };
  if (!std::ranges::is_sorted(rows, {}, of)) std::ranges::stable_sort(rows, {}, of);
  for (uint32_t i = 0; i < rows.size(); ++i) {
    WideRange& own = parts_[of(rows[i])].*range;
    if (own.begin == own.end) own.begin = i;
    own.end = i + 1;
  }
}

void WideIsland::part(const IslandSet& islands, std::span<const uint32_t> which) {
  parts_.assign(has_joints() ? which.size() : 0, {});
  if (!has_joints()) return;
  islands_.assign(slots_.size(), no_place);
  for (uint32_t k = 0; k < which.size(); ++k) {
    const Island& island = islands.islands[which[k]];
    for (uint32_t i = island.body_begin; i < island.body_end; ++i)
      islands_[local_[islands.bodies[i]]] = k;
  }
  part_rest(rest_rows_, &Part::rows);
  part_rest(joints_, &Part::joints);
}

/// Puts contacts into bundles by colour, those with equal numbers of points together as far as
/// possible.
void WideIsland::bundle() {
  for (uint32_t colour = 0; colour < colouring_.colours(); ++colour) {
    const auto begin = uint32_t(bundles_.size());
    const auto first = uint32_t(by_count_.size());
    for (int count = 4; count >= 0; --count)
      for (const uint32_t edge : colouring_.of(colour))
        if (counts_[edge] == count) by_count_.push_back(edge);
    for (auto i = first; i < by_count_.size(); i += uint32_t(wide_lanes)) {
      const uint32_t lanes = std::min(uint32_t(wide_lanes), uint32_t(by_count_.size()) - i);
      const uint32_t count = counts_[by_count_[i]];
      const bool turns = std::any_of(by_count_.begin() + i, by_count_.begin() + i + lanes,
                                     [this](uint32_t edge) { return turns_[edge] != 0; });
      bundles_.push_back(
          {i, lanes, bundled_points_, count, turns ? turning_bundles_++ : WideContact::no_turning});
      bundled_points_ += count;
    }
    colours_.push_back({begin, uint32_t(bundles_.size())});
  }
}

void WideIsland::add_memory(MemoryUse& use) const {
  use.bodies +=
      heap_bytes(slots_, local_, jointed_, careful_, rows_.bodies, rows_.masses, rows_.motions,
                 parts_, islands_, rest_of_, rest_bodies_, bodies_, motions_);
  use.contacts += heap_bytes(edges_, sources_, counts_, turns_, by_count_, bundles_, rows_.contacts,
                             rows_.points, rows_.turnings, rows_.rebounds, rows_.blow_changes,
                             rest_rows_, rest_points_);
  use.contacts += colouring_.bytes();
  use.joints +=
      heap_bytes(bundled_, rows_.joints, rows_.hinges, rows_.remembered, joints_, drives_);
}

}  // namespace tumble
