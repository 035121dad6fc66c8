#include "engine/scene/writer.hpp"

#include "engine/scene/visitors/json_text.hpp"
#include "engine/scene/visitors/object_writer.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {

Json to_json(const Colour& colour) {
  const double parts[3] = {colour.r, colour.g, colour.b};
  int bytes[3];
  bool exact = true;
  for (size_t i = 0; i < 3; ++i) {
    const double scaled = std::floor(parts[i] * 255 + 0.5);
    exact &= scaled >= 0 && scaled <= 255 && scaled / 255 == parts[i];
    bytes[i] = exact ? int(scaled) : 0;
  }
  if (!exact) return Json::array({colour.r, colour.g, colour.b});
  return fmt::format("#{:02x}{:02x}{:02x}", bytes[0], bytes[1], bytes[2]);
}

Json to_json(const Varying& number) {
  if (!number.course) return number.value;
  if (!number.text.empty()) return number.text;
  Json out = Json::array();
  for (const auto& [t, value] : number.course->points()) out.push_back(Json::array({t, value}));
  return out;
}

Json to_json(const TickRate& rate) {
  if (rate.den == 1) return rate.num;
  return fmt::format("{}/{}", rate.num, rate.den);
}

std::string write_scene(const SceneDescription& scene) {
  Json out = {{"$schema", "tumble.schema.json"}};
  const Json members = ObjectWriter::write_object(scene);
  for (const auto& item : members.items()) out[item.key()] = item.value();
  return pretty(out);
}

}  // namespace tumble
