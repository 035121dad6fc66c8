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

/// Proxies of all live bodies, ordered by body slot and shape: one about a body that is paired as a
/// whole (RigidBody::tree), or one for each shape. refs[i] says whose proxies[i] is; of a whole
/// body the shape is 0.
struct ProxySet {
  std::vector<BroadPhaseProxy> proxies;
  std::vector<ShapeRef> refs;
  std::vector<uint32_t> first;   ///< by body slot: its first proxy; and the end
  std::vector<uint32_t> owners;  ///< by proxy its body; none where no body has several proxies
  ProxyNews news;                ///< of the last update
  /// false: no dynamic body has a triangle mesh or looks far, so that no tick has parts.
  bool may_need_parts = true;

  uint32_t proxies_of(uint32_t body) const { return first[body + 1] - first[body]; }
};

/// How far apart two surfaces may be for a contact to be foreseen [m]: `margin`, less for small
/// bodies so that a pebble does not see the whole room.
double contact_margin(const RigidBody& body, double margin);

/// How far a body may come towards another in a tick before contacts foreseen at its start no
/// longer suffice [m]: its inner radius, or a tenth of its size where it is thinner.
double foresight(const RigidBody& body);

/// Whether a body can start new contacts: awake, and not a kinematic body at rest.
bool is_active(const RigidBody& body);

/// What a body's turning, at constant angular velocity, adds to the motion of one of its shapes in
/// a tick.
struct ShapeTurning {
  Vec3 velocity;  ///< of the shape's origin about the centre of mass, at the start [m/s]
  double reach;   ///< how far any point may leave what is carried along at that velocity [m]
};
ShapeTurning shape_turning(const RigidBody& body, const BodyShape& shape, double h);

/// Makes room for a proxy of every shape, of whole bodies too, and says where it is.
void number_shape_proxies(std::span<const RigidBody> bodies, ProxySet& out, Crew* crew = nullptr);

/// Fills the proxies: bounds over the tick [0, h] in which a body moves by v + h a and turns by
/// omega, widened by `margin`. A proxy is `moving` when its body seeks contacts.
/// `gravity` is the uniform acceleration [m/s2]. On the threads of the crew, if there is one.
void update_proxies(std::span<const RigidBody> bodies, const Vec3& gravity, double h, double margin,
                    ProxySet& out, Crew* crew = nullptr);

/// The same where `out` is what the tick before left: only what the roster names is touched.
void update_proxies(std::span<const RigidBody> bodies, const Roster& roster, const Vec3& gravity,
                    double h, double margin, ProxySet& out, Crew* crew = nullptr);

/// More pairs than a tick can hold: who is in most of them, and what to tell the user.
struct Crowd {
  uint32_t slot;
  Error error;
};
/// Empty where a tick can hold these pairs.
std::optional<Crowd> find_crowd(const ProxySet& proxies, std::span<const ProxyPair> pairs);

}  // namespace tumble
