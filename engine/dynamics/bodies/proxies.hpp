#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/core/crew.hpp"
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/roster.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// One shape of one body.
struct ShapeRef {
  uint32_t body = 0;   ///< slot
  uint32_t shape = 0;  ///< index into RigidBody::shapes
};

/// Proxies of all live bodies, ordered by body slot and shape: one for a body that is paired as a
/// whole (RigidBody::tree), otherwise one for each shape. refs[i] names the shape of proxies[i];
/// for a body that is paired as a whole it is shape 0.
struct ProxySet {
  std::vector<BroadPhaseProxy> proxies;
  std::vector<ShapeRef> refs;
  std::vector<uint32_t> first;  ///< by body slot: its first proxy; then the end
  /// By proxy: its body, or the group of that; empty if no body has several proxies or a group.
  std::vector<uint32_t> owners;
  ProxyNews news;  ///< of the last update
  /// False if no dynamic body has a triangle mesh or looks far: then ticks need not be divided into
  /// parts.
  bool may_need_parts = true;

  uint32_t proxies_of(uint32_t body) const { return first[body + 1] - first[body]; }
};

/// Gap up to which contacts of a body are foreseen even without motion [m]: `margin`, less for
/// small bodies, which would otherwise see much of their surroundings.
double contact_margin(const RigidBody& body, double margin);

/// How far a body may move towards another in a tick before the contacts foreseen at its start no
/// longer suffice [m]: its inner radius, or a tenth of its bounding radius if that is more.
double foresight(const RigidBody& body);

/// Whether a body can start new contacts: awake, and not a kinematic body at rest.
bool is_active(const RigidBody& body);

/// What a body's rotation, at constant angular velocity, adds to the motion of one of its shapes in
/// a tick.
struct ShapeTurning {
  Vec3 velocity;  ///< of the shape's origin about the centre of mass, at the start [m/s]
  double reach;   ///< greatest distance of any point from where that velocity would take it [m]
};
ShapeTurning shape_turning(const RigidBody& body, const BodyShape& shape, double h);

/// Makes room for a proxy of every shape, also of bodies that are paired as a whole, and sets
/// `first`.
void number_shape_proxies(std::span<const RigidBody> bodies, ProxySet& out, Crew* crew = nullptr);

/// Computes the proxies: bounds over a tick of h seconds, in which a body moves under uniform
/// acceleration `gravity` [m/s2] and rotates by omega, inflated by `margin` [m]. A proxy is
/// `moving` if its body is active. Runs on the threads of the crew, if there is one.
void update_proxies(std::span<const RigidBody> bodies, const Vec3& gravity, double h, double margin,
                    ProxySet& out, Crew* crew = nullptr);

/// The same where `out` holds the proxies of the previous tick: only bodies that the roster names
/// are updated.
void update_proxies(std::span<const RigidBody> bodies, const Roster& roster, const Vec3& gravity,
                    double h, double margin, ProxySet& out, Crew* crew = nullptr);

/// More pairs than a tick can hold: a body in most of them, and the error for the user.
struct Crowd {
  uint32_t slot;
  Error error;
};
/// Nothing if a tick can hold these pairs.
std::optional<Crowd> find_crowd(const ProxySet& proxies, std::span<const ProxyPair> pairs);

}  // namespace tumble
