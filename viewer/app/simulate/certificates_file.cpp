#include "viewer/app/simulate/certificates_file.hpp"

#include "engine/world/world.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <span>

#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

Json triple(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// A body by its slot, or a particle.
class Names {
 public:
  Names(const Frame& frame, std::span<const ParticleName> particles)
      : frame_(frame), particles_(particles) {}

  Json of(uint32_t slot) const {
    if ((slot & particle_bit) == 0) return {{"body", frame_.info(slot).name}, {"slot", slot}};
    const ParticleName& name = particles_[slot & ~particle_bit];
    for (const auto& system : frame_.particles)
      if (system->id == name.system)
        return {{"particles", system->name}, {"particle", name.particle}};
    return {{"particle", name.particle}};
  }
  Json side(uint32_t slot, uint32_t shape) const {
    Json out = of(slot);
    if ((slot & particle_bit) == 0) out["shape"] = shape;
    return out;
  }

 private:
  const Frame& frame_;
  std::span<const ParticleName> particles_;
};

Json to_json(const ContactCertificate& c, const Names& names) {
  return {{"a", names.side(c.key.body_a, c.key.shape_a)},
          {"b", names.side(c.key.body_b, c.key.shape_b)},
          {"position", triple(c.x_world)},
          {"normal", triple(c.normal)},
          {"gap", c.gap},
          {"accepted_depth", c.offset},
          {"normal_velocity", c.normal_velocity},
          {"slip_velocity", triple(c.slip_velocity)},
          {"normal_acceleration", c.normal_acceleration},
          {"slip_acceleration", triple(c.slip_acceleration)},
          {"force_on_b", triple(c.force)},
          {"friction", c.friction},
          {"mode", to_string(c.mode)},
          {"place_in_cone", c.place_in_cone},
          {"complementarity", c.complementarity},
          {"residual", c.residual},
          {"solver", c.solver}};
}

Json to_json(const BodyBalance& b, const Names& names) {
  Json out = names.of(b.body);
  out.update({{"smooth_force", triple(b.smooth_force)},
              {"contact_force", triple(b.contact_force)},
              {"joint_force", triple(b.joint_force)},
              {"momentum_rate", triple(b.momentum_rate)},
              {"smooth_torque", triple(b.smooth_torque)},
              {"contact_torque", triple(b.contact_torque)},
              {"joint_torque", triple(b.joint_torque)},
              {"angular_momentum_rate", triple(b.angular_rate)},
              {"residual", b.residual}});
  return out;
}

}  // namespace

Status write_certificates(const World& world, const std::filesystem::path& file) {
  const auto certificates = world.contact_certificates();
  if (!certificates) return certificates.error();
  const auto frame = world.frame();
  const Names names(*frame, certificates->particles);
  Json contacts = Json::array(), bodies = Json::array();
  for (const ContactCertificate& c : certificates->contacts) contacts.push_back(to_json(c, names));
  for (const BodyBalance& b : certificates->bodies) bodies.push_back(to_json(b, names));
  const Json out = {{"tick", frame->tick},
                    {"time", frame->time},
                    {"stepper", world.settings().stepper},
                    {"contacts", contacts},
                    {"bodies", bodies}};
  return write_file(file, out.dump(1) + "\n");
}

}  // namespace tumble
