#include "engine/dynamics/rigid/proxies.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tumble {

double contact_margin(const RigidBody& body, double margin) {
  // A fixed or kinematic body leaves the choice to its dynamic partner.
  if (!body.dynamic() || !std::isfinite(body.bounding_radius)) return margin;
  return std::min(margin, 0.1 * body.bounding_radius);
}

double foresight(const RigidBody& body) {
  return std::max(body.inner_radius, 0.1 * body.bounding_radius);
}

bool seeks_contacts(const RigidBody& body) {
  if (!body.awake()) return false;
  return body.dynamic() || !body.v.isZero(0) || !body.omega.isZero(0);
}

namespace {

/// Puts the proxies of a body from `out` on; whether it is a dynamic body with a triangle mesh.
bool put_proxies(const RigidBody& body, uint32_t slot, const Vec3& gravity, double h, double margin,
                 BroadPhaseProxy* out, ShapeRef* refs) {
  const bool moving = seeks_contacts(body);
  Vec3 step = Vec3::Zero();
  if (moving) {
    step = h * body.v;
    if (body.dynamic()) {
      step += h * h * (body.gravity_scale * gravity + body.inverse_mass * body.force);
    }
  }
  const double turn = moving ? body.omega.norm() * h : 0;
  const double wide = contact_margin(body, margin);
  bool mesh = false;
  for (uint32_t s = 0; s < body.shapes.size(); ++s) {
    const Shape& shape = *body.shapes[s].shape;
    mesh |= shape.type() == ShapeType::triangle_mesh;
    const Aabb now = shape.bounds(body.pose * body.shapes[s].pose);
    Aabb bounds = now;
    bounds.min += step.cwiseMin(Vec3::Zero());
    bounds.max += step.cwiseMax(Vec3::Zero());
    // No point moves farther by turning than twice its distance from the centre.
    const double reach = turn > 0 ? std::min(turn, 2.0) * body.bounding_radius : 0;
    out[s] = {bounds.inflated(wide + reach), moving};
    refs[s] = {slot, s};
  }
  return mesh && body.dynamic();
}

}  // namespace

void update_proxies(std::span<const RigidBody> bodies, const Vec3& gravity, double h, double margin,
                    ProxySet& out, Crew* crew) {
  std::array<size_t, chunk_count> begins{};  // of what each chunk puts; counts at first
  for_chunks(crew, bodies.size(), [&](size_t chunk, size_t first, size_t last) {
    size_t count = 0;
    for (size_t i = first; i < last; ++i) count += bodies[i].shapes.size();
    begins[chunk] = count;
  });
  size_t total = 0;
  for (size_t& begin : begins) begin = std::exchange(total, total + begin);
  out.proxies.resize(total);
  out.refs.resize(total);
  std::array<bool, chunk_count> meshes{};
  for_chunks(crew, bodies.size(), [&](size_t chunk, size_t first, size_t last) {
    constexpr size_t ahead = 8;
    size_t at = begins[chunk];
    bool mesh = false;
    for (size_t i = first; i < last; ++i) {
      prefetch_ahead<sizeof(RigidBody)>(bodies, i, 2 * ahead);
      if (i + ahead < last) prefetch<sizeof(BodyShape)>(bodies[i + ahead].shapes.data());
      mesh |= put_proxies(bodies[i], uint32_t(i), gravity, h, margin, out.proxies.data() + at,
                          out.refs.data() + at);
      at += bodies[i].shapes.size();
    }
    meshes[chunk] = mesh;
  });
  out.moving_meshes = std::ranges::any_of(meshes, [](bool mesh) { return mesh; });
}

}  // namespace tumble
