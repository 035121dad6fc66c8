#include "engine/scene/schema.hpp"

#include "engine/scene/visitors/json_text.hpp"
#include "engine/scene/visitors/known_names.hpp"
#include "engine/scene/visitors/schema_visitor.hpp"
#include "engine/scene/visitors/value_text.hpp"

namespace tumble {

void SchemaVisitor::put(const Parameter& p, Json schema) {
  std::string doc(p.doc);
  if (!p.unit.empty()) doc += " [" + std::string(p.unit) + "]";
  // Draft 7 ignores what stands beside a $ref.
  if (schema.contains("$ref")) {
    Json wrapped = {{"allOf", Json::array({Json{{"$ref", schema["$ref"]}}})}};
    if (schema.contains("default")) wrapped["default"] = schema["default"];
    schema = std::move(wrapped);
  }
  if (!doc.empty()) schema["description"] = doc;
  if (p.required) required_.emplace_back(p.name);
  properties_[std::string(p.name)] = std::move(schema);
}

Json SchemaVisitor::number(const Parameter& declared, const char* type) {
  const Parameter p = bounded(declared);
  Json number = {{"type", type}};
  if (std::isfinite(p.min)) number[p.exclusive_min ? "exclusiveMinimum" : "minimum"] = p.min;
  if (std::isfinite(p.max)) number["maximum"] = p.max;
  return {{"anyOf", Json::array({std::move(number), Json{{"$ref", "#/definitions/expression"}}})}};
}

Json SchemaVisitor::leaf(uint64_t, const Parameter&) {
  return {{"anyOf",
           Json::array({Json{{"type", "integer"}}, Json{{"$ref", "#/definitions/expression"}}})}};
}

Json SchemaVisitor::leaf(const std::string&, const Parameter& p) {
  Json names = Json::array();
  for (const std::string& name : known_names(p.name)) names.push_back(name);
  if (!names.empty()) return {{"enum", std::move(names)}};
  return {{"type", "string"}};
}

Json SchemaVisitor::array(Json item, size_t count) {
  return {{"type", "array"}, {"items", std::move(item)}, {"minItems", count}, {"maxItems", count}};
}

Json SchemaVisitor::leaf(const TickRate&, const Parameter& p) {
  Json out = number(p, "integer");
  out["anyOf"].push_back({{"type", "string"}, {"pattern", "^[0-9]+/[0-9]+$"}});
  return out;
}

Json SchemaVisitor::take() {
  const auto closed = [](Json properties, const std::vector<std::string>& required) {
    Json out = {
        {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
    if (!required.empty()) out["required"] = required;
    return out;
  };
  if (alternatives_.empty()) return closed(properties_, required_);
  Json variants = Json::array();
  for (Alternative& a : alternatives_) {
    for (const auto& item : properties_.items()) a.properties[item.key()] = item.value();
    a.required.insert(a.required.end(), required_.begin(), required_.end());
    variants.push_back(closed(std::move(a.properties), a.required));
  }
  return {{"oneOf", std::move(variants)}};
}

std::string scene_schema() {
  Json names = Json::array();
  for (const std::string& name : palette_names()) names.push_back(name);
  Json definitions = {
      {"expression",
       {{"type", "string"},
        {"pattern", "^[$=]"},
        {"description",
         "\"$name\" of a parameter, or \"= expression\" over parameters, and over "
         "the time t where a value may change"}}},
      {"colour",
       {{"anyOf",
         Json::array({Json{{"enum", std::move(names)}},
                      Json{{"type", "string"}, {"pattern", "^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$"}},
                      Json{{"type", "array"},
                           {"items", {{"type", "number"}, {"minimum", 0}, {"maximum", 1}}},
                           {"minItems", 3},
                           {"maxItems", 3}}})}}}};
  SchemaVisitor visitor(definitions);
  Json scene = visitor.describe<SceneDescription>();
  scene["properties"]["$schema"] = {{"type", "string"}};
  Json out = {{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "Tumble scene"},
              {"description", "Made from the engine's declarations; see scenes/README.md."}};
  for (const auto& item : scene.items()) out[item.key()] = item.value();
  out["definitions"] = std::move(definitions);
  return pretty(out);
}

}  // namespace tumble
