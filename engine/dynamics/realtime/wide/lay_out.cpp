// Which body, contact and joint goes where.
#include "engine/core/chunks.hpp"
#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/realtime/wide/wide_island.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

constexpr uint32_t no_place = ~uint32_t{0};

bool turns_fast(const RigidBody& body, double h) {
  return body.omega.squaredNorm() * h * h > 0.04;
}

bool equal_moments(const RigidBody& body) {
  const Mat3& I = body.inertia_body;
  return (I - I(0, 0) * Mat3::Identity()).cwiseAbs().maxCoeff() <= 1e-12 * I(0, 0);
}

/// Whether a point of the contact is not on a round surface of the body: a ball's lever arms do not
/// turn with it, its surface rolls under them.
bool turns_arms(const Contact& contact, bool of_a) {
  const double rounding = of_a ? contact.rounding_a : contact.rounding_b;
  return std::ranges::any_of(contact.used(), [&](const ContactPoint& p) {
    return (of_a ? p.anchor_a : p.anchor_b).norm() > rounding * (1 + 1e-9);
  });
}

}  // namespace

uint8_t WideIsland::traits_of(const RigidBody& body, double h) {
  if (body.type == BodyType::fixed) return 0;
  const bool spins = turns_fast(body, h);
  if (!body.dynamic()) return uint8_t(kinematic | (spins ? fast : 0));
  if (body.asleep) return 0;
  const bool slender = slender_inertia(body.inertia_body).has_value();
  uint8_t traits = dynamic;
  if (spins || slender) traits |= fast;
  if (slender || (spins && !equal_moments(body))) traits |= careful;
  return traits;
}

void WideIsland::clear(const SolverContext& c, std::span<const uint32_t> involved) {
  slots_.clear();
  local_.resize(c.bodies.size());
  jointed_.resize(c.bodies.size());
  for (const uint32_t slot : involved) local_[slot] = no_place, jointed_[slot] = 0;
  bundled_.resize(c.joints.size());
  edges_.clear();
  sources_.clear();
  counts_.clear();
  by_count_.clear();
  bundles_.clear();
  bundled_points_ = 0;
  colours_.clear();
  rest_bodies_.clear();
  rest_rows_.clear();
  rest_points_.clear();
  joints_.clear();
  joint_bundles_.clear();
  simple_ = special_ = fixed_ = 0;
  points_ = 0;
}

uint32_t WideIsland::add_body(uint32_t slot) {
  if (slot != no_place) local_[slot] = uint32_t(slots_.size());
  slots_.push_back(slot);
  return uint32_t(slots_.size() - 1);
}

/// Bodies that the kernels integrate, then those that need care, then what stands for fixed ones.
void WideIsland::add_bodies(const SolverContext& c, const IslandSet& islands,
                            std::span<const uint32_t> which, Crew& crew) {
  traits_.resize(c.bodies.size());
  const std::span<const uint32_t> involved = islands.involved;
  for_chunks(&crew, involved.size(), [&](size_t, size_t first, size_t last) {
    for (const uint32_t i : involved.subspan(first, last - first))
      traits_[i] = traits_of(c.bodies[i], c.h);
  });
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
      if ((jointed_[slot] & by_row) || (traits_[slot] & careful)) {
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
  if (slot == no_body || !(traits_[slot] & (dynamic | kinematic))) return fixed_;
  return local_[slot] != no_place ? local_[slot] : add_body(slot);  // kinematic, seen first here
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
  const auto [a, b, points] = islands.ends[source];
  const uint8_t of_a = traits_[a], of_b = traits_[b];
  if (((of_a & fast) && turns_arms(c.contacts[source], true)) ||
      ((of_b & fast) && turns_arms(c.contacts[source], false))) {
    add_rest_row(source, islands.ends[source]);
    return;
  }
  edges_.push_back(
      {of_a & dynamic ? find(a) : ColourEdge::fixed, of_b & dynamic ? find(b) : ColourEdge::fixed});
  sources_.push_back(source);
  counts_.push_back(uint8_t(points));
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
}

void WideIsland::lay_out(const SolverContext& c, const IslandSet& islands,
                         std::span<const uint32_t> which, Crew& crew) {
  clear(c, islands.involved);
  if (which.empty()) return;
  add_bodies(c, islands, which, crew);
  rest_of_.assign(slots_.size(), no_place);
  // What is integrated in double precision comes first in the rest: those that need care, and
  // kinematic bodies, which the joints and contacts below bring in.
  for (uint32_t k = simple_; k < fixed_; ++k) in_rest(k);
  for (const uint32_t k : which) {
    const Island& island = islands.islands[k];
    for (uint32_t i = island.contact_begin; i < island.contact_end; ++i) {
      const IslandSet::Ends& ends = islands.ends[islands.contacts[i]];
      for (const uint32_t slot : {ends.a, ends.b})
        if (traits_[slot] & kinematic) in_rest(find(slot));
    }
    for (uint32_t i = island.joint_begin; i < island.joint_end; ++i) {
      const Joint& joint = c.joints[islands.joints[i]];
      for (const uint32_t slot : {joint.a, joint.b})
        if (slot != no_body && (traits_[slot] & kinematic)) in_rest(find(slot));
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
  bundle();
}

/// Contacts of a colour with the same number of points share bundles as far as possible.
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
      bundles_.push_back({i, lanes, bundled_points_, count});
      bundled_points_ += count;
    }
    colours_.push_back({begin, uint32_t(bundles_.size())});
  }
}

void WideIsland::add_memory(MemoryUse& use) const {
  use.bodies += heap_bytes(slots_, local_, traits_, jointed_, careful_, rows_.bodies, rows_.masses,
                           rows_.motions, rest_of_, rest_bodies_, bodies_, motions_);
  use.contacts += heap_bytes(edges_, sources_, counts_, by_count_, bundles_, rows_.contacts,
                             rows_.points, rest_rows_, rest_points_);
  use.contacts += colouring_.bytes();
  use.joints += heap_bytes(bundled_, rows_.joints, rows_.hinges, joints_);
}

}  // namespace tumble
