#include "viewer/app/simulate/certificates_file.hpp"

#include "viewer/capture/atomic_file.hpp"

#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

Json triple(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json side(const Frame& frame, uint32_t body, uint32_t shape) {
  return {{"body", frame.info(body).name}, {"slot", body}, {"shape", shape}};
}

Json to_json(const ContactCertificate& c, const Frame& frame) {
  return {{"a", side(frame, c.key.body_a, c.key.shape_a)},
          {"b", side(frame, c.key.body_b, c.key.shape_b)},
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

Json to_json(const BodyBalance& b, const Frame& frame) {
  return {{"body", frame.info(b.body).name},
          {"slot", b.body},
          {"smooth_force", triple(b.smooth_force)},
          {"contact_force", triple(b.contact_force)},
          {"momentum_rate", triple(b.momentum_rate)},
          {"smooth_torque", triple(b.smooth_torque)},
          {"contact_torque", triple(b.contact_torque)},
          {"angular_momentum_rate", triple(b.angular_rate)},
          {"residual", b.residual}};
}

}  // namespace

Status write_certificates(const World& world, const std::filesystem::path& file) {
  const auto certificates = world.contact_certificates();
  if (!certificates) return certificates.error();
  const auto frame = world.frame();
  Json contacts = Json::array(), bodies = Json::array();
  for (const ContactCertificate& c : certificates->contacts) contacts.push_back(to_json(c, *frame));
  for (const BodyBalance& b : certificates->bodies) bodies.push_back(to_json(b, *frame));
  const Json out = {{"tick", frame->tick},
                    {"time", frame->time},
                    {"stepper", world.settings().stepper},
                    {"contacts", contacts},
                    {"bodies", bodies}};
  return write_file(file, out.dump(1) + "\n");
}

}  // namespace tumble
