#include "engine/scene/schema.hpp"

#include "engine/scene/description.hpp"
#include "engine/scene/visitors/json_text.hpp"
#include "engine/scene/visitors/known_names.hpp"
#include "engine/scene/visitors/object_writer.hpp"
#include "engine/scene/visitors/value_text.hpp"

#include <cmath>

namespace tumble {
namespace {

/// Visitor that describes a struct as a JSON Schema object.
class SchemaVisitor final : public StructVisitor {
 public:
  explicit SchemaVisitor(Json& definitions) : definitions_(definitions) {}

  void field(const Leaf& value, const Parameter& p) override;
  void object(const StructRef& value, const Parameter& p) override {
    put(p, reference(*value.type));
  }
  void object(const OptionalRef& value, const Parameter& p) override {
    put(p, reference(*value.type->item));
  }
  void list(const ListRef& values, const Parameter& p) override {
    const Json item = reference(*values.type->item);
    Json several = {{"type", "array"}, {"items", item}};
    if (values.type->item == &struct_type<DrawnDescription>()) several["minItems"] = 1;
    put(p, {{"anyOf", Json::array({item, several})}});
  }
  void map(const MapRef& values, const Parameter& p) override;
  void one_of(const VariantRef& value, const Parameter& p) override;
  void part(const StructRef& value) override { value.type->parameters(value.object, *this); }

  /// The schema of the struct that was visited.
  Json take();

  Json describe(const StructType& type);

 private:
  /// A reference to the definition of a struct, which is made on first use; structs without a
  /// schema_name are written in place.
  Json reference(const StructType& type);
  void show_defaults(const StructType& type) {
    part(StructRef{const_cast<void*>(type.defaults), &type});
  }
  void put(const Parameter& p, Json schema);

  struct Alternative {
    Json properties;
    std::vector<std::string> required;
  };
  Json& definitions_;
  Json properties_ = Json::object();
  std::vector<std::string> required_;
  std::vector<Alternative> alternatives_;
};

Json number(const Parameter& declared, const char* type) {
  const Parameter p = bounded(declared);
  Json number = {{"type", type}};
  if (std::isfinite(p.min)) number[p.exclusive_min ? "exclusiveMinimum" : "minimum"] = p.min;
  if (std::isfinite(p.max)) number["maximum"] = p.max;
  return {{"anyOf", Json::array({std::move(number), Json{{"$ref", "#/definitions/expression"}}})}};
}

Json array(Json item, size_t count) {
  return {{"type", "array"}, {"items", std::move(item)}, {"minItems", count}, {"maxItems", count}};
}

// Schemas of leaves.
Json schema_of(const Leaf& leaf, const Parameter& p);

Json schema_of(const double*, const Parameter& p) {
  return number(p, "number");
}
Json schema_of(const Varying*, const Parameter& p) {
  Json out = number(p, "number");
  out["anyOf"].push_back({{"type", "array"}, {"items", array({{"type", "number"}}, 2)}});
  return out;
}
Json schema_of(const VaryingVec3*, const Parameter& p) {
  return array(schema_of(static_cast<const Varying*>(nullptr), p), 3);
}
Json schema_of(const int*, const Parameter& p) {
  return number(p, "integer");
}
Json schema_of(const uint64_t*, const Parameter&) {
  return {{"anyOf",
           Json::array({Json{{"type", "integer"}}, Json{{"$ref", "#/definitions/expression"}}})}};
}
Json schema_of(const bool*, const Parameter&) {
  return {{"type", "boolean"}};
}
Json schema_of(const std::string*, const Parameter& p) {
  Json names = Json::array();
  for (const std::string& name : known_names(p.name)) names.push_back(name);
  if (!names.empty()) return {{"enum", std::move(names)}};
  return {{"type", "string"}};
}
Json schema_of(const Vec3*, const Parameter& p) {
  return array(number(p, "number"), 3);
}
Json schema_of(const Quat*, const Parameter& p) {
  return array(number(p, "number"), 4);
}
Json schema_of(const std::array<int, 3>*, const Parameter& p) {
  return array(number(p, "integer"), 3);
}
Json schema_of(const Colour*, const Parameter&) {
  return {{"$ref", "#/definitions/colour"}};
}
Json schema_of(const TickRate*, const Parameter& p) {
  Json out = number(p, "integer");
  out["anyOf"].push_back({{"type", "string"}, {"pattern", "^[0-9]+/[0-9]+$"}});
  return out;
}
Json schema_of(const EnumRef& value, const Parameter&) {
  return {{"enum", value.type->names}};
}
Json schema_of(const OptionalLeafRef& value, const Parameter& p) {
  return schema_of(value.type->sample(), p);
}
Json schema_of(const LeafListRef& values, const Parameter& p) {
  return {{"type", "array"}, {"items", schema_of(values.type->sample(), p)}};
}
Json schema_of(const Leaf& leaf, const Parameter& p) {
  return std::visit([&](const auto& value) { return schema_of(value, p); },
                    static_cast<const Leaf::variant&>(leaf));
}

void SchemaVisitor::field(const Leaf& value, const Parameter& p) {
  Json schema = schema_of(value, p);
  const auto* option = std::get_if<OptionalLeafRef>(&value);
  if (!p.required && (!option || option->type->has(option->option)))
    schema["default"] = to_json(value);
  put(p, std::move(schema));
}

void SchemaVisitor::map(const MapRef& values, const Parameter& p) {
  const StructType& item = *values.type->item;
  const char* names =
      &item == &struct_type<CopyDescription>() ? "^[0-9]{1,9}$" : "^[A-Za-z_][A-Za-z0-9_]{0,63}$";
  put(p, {{"type", "object"},
          {"propertyNames", {{"pattern", names}}},
          {"additionalProperties", reference(item)}});
}

void SchemaVisitor::one_of(const VariantRef& value, const Parameter& p) {
  for (const StructType* type : value.type->alternatives) {
    SchemaVisitor inner(definitions_);
    inner.show_defaults(*type);
    Json properties = {{std::string(p.name), {{"const", std::string(type->type_name)}}}};
    for (const auto& item : inner.properties_.items()) properties[item.key()] = item.value();
    inner.required_.insert(inner.required_.begin(), std::string(p.name));
    alternatives_.push_back({std::move(properties), std::move(inner.required_)});
  }
}

Json SchemaVisitor::reference(const StructType& type) {
  if (type.schema_name.empty()) return describe(type);
  const std::string name(type.schema_name);
  if (!definitions_.contains(name)) {
    definitions_[name] = nullptr;  // reserves its place in the order
    Json made = describe(type);
    definitions_[name] = std::move(made);
  }
  return {{"$ref", "#/definitions/" + name}};
}

Json SchemaVisitor::describe(const StructType& type) {
  SchemaVisitor inner(definitions_);
  inner.show_defaults(type);
  Json object = inner.take();
  if (type.shorthand_key.empty()) return object;
  Json bare = inner.properties_[std::string(type.shorthand_key)];
  return {{"anyOf", Json::array({std::move(bare), std::move(object)})}};
}

void SchemaVisitor::put(const Parameter& p, Json schema) {
  std::string doc(p.doc);
  if (!p.unit.empty()) doc += " [" + std::string(p.unit) + "]";
  // Draft 7 ignores keys beside a $ref.
  if (schema.contains("$ref")) {
    Json wrapped = {{"allOf", Json::array({Json{{"$ref", schema["$ref"]}}})}};
    if (schema.contains("default")) wrapped["default"] = schema["default"];
    schema = std::move(wrapped);
  }
  if (!doc.empty()) schema["description"] = doc;
  if (p.required) required_.emplace_back(p.name);
  properties_[std::string(p.name)] = std::move(schema);
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

}  // namespace

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
  Json scene = visitor.describe(struct_type<SceneDescription>());
  scene["properties"]["$schema"] = {{"type", "string"}};
  Json out = {{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "Tumble scene"},
              {"description", "Made from the engine's declarations; see scenes/README.md."}};
  for (const auto& item : scene.items()) out[item.key()] = item.value();
  out["definitions"] = std::move(definitions);
  return pretty(out);
}

}  // namespace tumble
