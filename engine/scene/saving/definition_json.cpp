#include "engine/scene/saving/definition_json.hpp"

#include "engine/scene/build/describe_body.hpp"
#include "engine/scene/build/describe_joint.hpp"
#include "engine/scene/visitors/object_writer.hpp"

namespace tumble {

std::string one_line(const Json& value) {
  if (value.is_array()) {
    std::string out = "[";
    for (size_t i = 0; i < value.size(); ++i) out += (i ? ", " : "") + one_line(value[i]);
    return out + "]";
  }
  if (!value.is_object()) return value.dump();
  if (value.empty()) return "{}";
  std::string out = "{ ";
  for (const auto& item : value.items())
    out += (out.size() > 2 ? ", " : "") + Json(item.key()).dump() + ": " + one_line(item.value());
  return out + " }";
}

Json number_of(const ShapeDef& shape, const ShapeParameter& p) {
  if (p.number) return shape.*p.number / p.factor;
  return to_json(Vec3(shape.*p.vector / p.factor));
}

Json material_json(const Material& material) {
  const Json all = write_all(describe_material(material));
  for (const auto& [name, m] : built_in_materials())
    if (write_all(describe_material(m)) == all) return std::string(name);
  const Json usual = write_all(describe_material(Material{}));
  Json out = Json::object();
  for (const auto& item : all.items())
    if (usual[item.key()] != item.value()) out[item.key()] = item.value();
  return out;
}

void put_material(Json& body, const Material& material) {
  if (write_all(describe_material(material)) != write_all(describe_material(Material{})))
    body["material"] = material_json(material);
}

Json shape_json(const BodyShapeDef& part) {
  Json shape = {{"type", std::string(shape_entry(part.shape.type).name)}};
  for (const ShapeParameter& p : shape_entry(part.shape.type).parameters)
    shape[std::string(p.parameter.name)] = number_of(part.shape, p);
  Placement place;
  place.position = part.pose.x;
  place.turn(part.pose.q);
  if (!place.position.isZero(0)) shape["position"] = to_json(place.position);
  if (place.euler_deg) shape["euler_deg"] = to_json(*place.euler_deg);
  if (place.orientation) shape["orientation"] = to_json(*place.orientation);
  return shape;
}

Json body_json(const BodyDef& def) {
  BodyDescription d = describe_body(def);
  d.placement.turn(def.pose.q);
  Json out = write_object(d);
  Json shapes = Json::array();
  for (const BodyShapeDef& part : def.shapes) {
    Json shape = shape_json(part);
    // The material of the first shape is that of the body.
    if (Json own = material_json(part.material); own != material_json(def.shapes[0].material))
      shape["material"] = std::move(own);
    shapes.push_back(std::move(shape));
  }
  if (shapes.size() == 1)
    out["shape"] = shapes[0];
  else
    out["shapes"] = std::move(shapes);
  if (!def.shapes.empty()) put_material(out, def.shapes[0].material);
  return out;
}

Json drive_json(const CoordinateDrive& drive, bool angle) {
  return write_object(describe_drive(drive, angle));
}

Json part_json(const PartDescription& part) {
  return std::visit([](const auto& d) { return write_object(d); }, part);
}

}  // namespace tumble
