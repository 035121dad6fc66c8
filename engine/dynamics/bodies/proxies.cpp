#include "engine/dynamics/bodies/proxies.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/dynamics/bodies/whole_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

namespace tumble {

double contact_margin(const RigidBody& body, double margin) {
  // For a pair with a fixed or kinematic body the margin of the dynamic one decides.
  if (!body.dynamic() || !std::isfinite(body.bounding_radius)) return margin;
  return std::min(margin, tolerances::margin_of_radius * body.bounding_radius);
}

double foresight(const RigidBody& body) {
  return std::max(body.inner_radius, tolerances::foresight_of_radius * body.bounding_radius);
}

bool is_active(const RigidBody& body) {
  if (!body.awake()) return false;
  return body.dynamic() || !body.v.isZero(0) || !body.omega.isZero(0);
}

ShapeTurning shape_turning(const RigidBody& body, const BodyShape& shape, double h) {
  const double angle = body.omega.norm() * h;
  if (angle == 0) return {Vec3::Zero(), 0};
  // By rotation no point moves farther than twice its distance from the centre.
  if (angle >= tolerances::series_turn)
    return {Vec3::Zero(), std::min(angle, 2.0) * body.bounding_radius};
  const Vec3 origin = body.pose.direction(shape.pose.x);
  return {body.omega.cross(origin),
          angle * shape.shape->bounding_radius() + 0.5 * angle * angle * origin.norm()};
}

namespace {

/// Parameters of a tick that are the same for all bodies.
struct Tick {
  Vec3 gravity;
  double h, margin;
};

/// Writes the proxies of a body; returns whether its tick may have to be divided into parts.
bool put_proxies(const RigidBody& body, uint32_t slot, const Tick& tick, ProxySet& out) {
  const bool moving = is_active(body);
  const double h = tick.h;
  Vec3 step = Vec3::Zero();
  if (moving) {
    step = h * body.v;
    if (body.dynamic()) {
      step += h * h * (body.gravity_scale * tick.gravity + body.inverse_mass * body.force);
    }
  }
  const double wide = contact_margin(body, tick.margin);
  bool mesh = false;
  for (const BodyShape& s : body.shapes) mesh |= s.shape->is_mesh();
  const uint32_t first = out.first[slot];
  const auto put = [&](uint32_t s, Aabb bounds, const ShapeTurning& turning) {
    const Vec3 way = step + h * turning.velocity;
    bounds.min += way.cwiseMin(Vec3::Zero());
    bounds.max += way.cwiseMax(Vec3::Zero());
    out.proxies[first + s] = {bounds.inflated(wide + turning.reach), moving};
    out.refs[first + s] = {slot, s};
  };
  if (body.tree) {
    put(0, whole_bounds(*body.tree, body.pose),
        {Vec3::Zero(), moving ? whole_turning(body, h) : 0});
  } else {
    for (uint32_t s = 0; s < body.shapes.size(); ++s)
      put(s, body.shapes[s].shape->bounds(body.pose * body.shapes[s].pose),
          moving ? shape_turning(body, body.shapes[s], h) : ShapeTurning{Vec3::Zero(), 0});
  }
  return (mesh || body.looks_far) && body.dynamic();
}

/// Number of proxies of a body.
uint32_t proxies_for(const RigidBody& body) {
  return body.tree ? 1 : uint32_t(body.shapes.size());
}

/// Whether any body has several proxies, judged by their first indices.
bool several_of_one(const ProxySet& set) {
  return std::ranges::adjacent_find(set.first, [](uint32_t begin, uint32_t end) {
           return end - begin > 1;
         }) != set.first.end();
}

/// What the broad phase takes for the owner of a body's proxies: the bodies of a group share one,
/// so that their pairs, which the filter would drop, are never collected. Groups whose number would
/// be that of a body are left to the filter.
uint32_t owner_of(const RigidBody& body, uint32_t slot, size_t bodies) {
  const uint32_t group = ~body.group;
  return body.group != 0 && group >= bodies ? group : slot;
}

void set_owners(std::span<const RigidBody> bodies, ProxySet& out) {
  out.owners.clear();
  const bool grouped = std::ranges::any_of(bodies, [](const RigidBody& b) { return b.group != 0; });
  if (!grouped && !several_of_one(out)) return;
  out.owners.reserve(out.first.back());
  for (uint32_t i = 0; i < bodies.size(); ++i)
    out.owners.insert(out.owners.end(), out.proxies_of(i), owner_of(bodies[i], i, bodies.size()));
}

void append_proxies_of(const ProxySet& set, std::span<const uint32_t> bodies,
                       std::vector<uint32_t>& out) {
  out.clear();
  for (const uint32_t body : bodies)
    for (uint32_t p = set.first[body]; p < set.first[body + 1]; ++p) out.push_back(p);
}

/// Sets the index of each body's first proxy; a body has count(body) of them.
template <class Count>
void number_proxies(std::span<const RigidBody> bodies, ProxySet& out, Crew* crew,
                    const Count& count) {
  out.first.resize(bodies.size() + 1);
  for_chunks(crew, bodies.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      prefetch<1>(&bodies[std::min(i + tolerances::bodies_ahead, last - 1)].shapes);
      out.first[i] = count(bodies[i]);
    }
  });
  out.first.back() = 0;
  uint32_t total = 0;
  for (uint32_t& begin : out.first) begin = std::exchange(total, total + begin);
  set_owners(bodies, out);
  out.proxies.resize(total);
  out.refs.resize(total);
}

}  // namespace

void number_shape_proxies(std::span<const RigidBody> bodies, ProxySet& out, Crew* crew) {
  number_proxies(bodies, out, crew, [](const RigidBody& b) { return uint32_t(b.shapes.size()); });
}

void update_proxies(std::span<const RigidBody> bodies, const Vec3& gravity, double h, double margin,
                    ProxySet& out, Crew* crew) {
  number_proxies(bodies, out, crew, &proxies_for);
  std::array<bool, chunk_count> meshes{};
  for_chunks(crew, bodies.size(), [&](size_t chunk, size_t first, size_t last) {
    constexpr size_t ahead = tolerances::bodies_ahead;
    bool mesh = false;
    for (size_t i = first; i < last; ++i) {
      prefetch_ahead<sizeof(RigidBody)>(bodies, i, 2 * ahead);
      if (i + ahead < last) prefetch<sizeof(BodyShape)>(bodies[i + ahead].shapes.data());
      mesh |= put_proxies(bodies[i], uint32_t(i), {gravity, h, margin}, out);
    }
    meshes[chunk] = mesh;
  });
  out.may_need_parts = std::ranges::any_of(meshes, std::identity());
  out.news.everything(out.proxies);
}

void update_proxies(std::span<const RigidBody> bodies, const Roster& roster, const Vec3& gravity,
                    double h, double margin, ProxySet& out, Crew* crew) {
  if (roster.everything() || out.first.size() != bodies.size() + 1)
    return update_proxies(bodies, gravity, h, margin, out, crew);
  for (const std::span<const uint32_t> slots : {roster.active(), roster.settled()}) {
    for_chunks(crew, slots.size(), [&](size_t, size_t first, size_t last) {
      constexpr size_t ahead = tolerances::bodies_ahead;
      for (size_t k = first; k < last; ++k) {
        prefetch<sizeof(RigidBody)>(&bodies[slots[std::min(k + 2 * ahead, last - 1)]]);
        prefetch<sizeof(BodyShape)>(bodies[slots[std::min(k + ahead, last - 1)]].shapes.data());
        put_proxies(bodies[slots[k]], slots[k], {gravity, h, margin}, out);
      }
    });
  }
  append_proxies_of(out, roster.active(), out.news.moving);
  append_proxies_of(out, roster.settled(), out.news.settled);
  ++out.news.number;
  out.news.all = false;
}

std::optional<Crowd> find_crowd(const ProxySet& proxies, std::span<const ProxyPair> pairs) {
  if (pairs.size() <=
      tolerances::pairs_at_least + tolerances::pairs_per_shape * proxies.proxies.size())
    return std::nullopt;
  std::vector<uint32_t> count(proxies.refs.back().body + size_t{1});  // refs ascend by body
  for (const ProxyPair& p : pairs)
    for (const uint32_t shape : {p.a, p.b}) ++count[proxies.refs[shape].body];
  return Crowd{uint32_t(std::ranges::max_element(count) - count.begin()),
               Error{ErrorCode::numeric,
                     fmt::format("{} bounds lie so densely that {} pairs of them overlap, more "
                                 "than a tick can hold",
                                 proxies.proxies.size(), pairs.size()),
                     {},
                     "place them apart"}};
}

}  // namespace tumble
