#pragma once
#include "engine/scene/visitors/object_writer.hpp"

#include <cmath>

namespace tumble {

/// Visitor that describes a struct as a JSON Schema object.
class SchemaVisitor {
 public:
  explicit SchemaVisitor(Json& definitions) : definitions_(definitions) {}

  template <class T>
  void field(const T& value, const Parameter& p) {
    Json schema = leaf(value, p);
    const One<T> one{value};
    const Json written = ObjectWriter::write_all(one);
    if (!p.required && written.contains("v")) schema["default"] = written["v"];
    put(p, std::move(schema));
  }
  template <class T>
  void object(const T&, const Parameter& p) {
    put(p, reference<T>());
  }
  template <class T>
  void object(const std::optional<T>&, const Parameter& p) {
    put(p, reference<T>());
  }
  template <class T>
  void list(const std::vector<T>&, const Parameter& p) {
    const Json item = reference<T>();
    put(p, {{"anyOf", Json::array({item, Json{{"type", "array"}, {"items", item}}})}});
  }
  template <class T>
  void map(const NamedList<T>&, const Parameter& p) {
    const char* names =
        std::is_same_v<T, CopyDescription> ? "^[0-9]{1,9}$" : "^[A-Za-z_][A-Za-z0-9_]{0,63}$";
    put(p, {{"type", "object"},
            {"propertyNames", {{"pattern", names}}},
            {"additionalProperties", reference<T>()}});
  }
  template <class... Ts>
  void one_of(const std::variant<Ts...>&, const Parameter& p) {
    (alternative<Ts>(p), ...);
  }
  template <class T>
  void part(const T& value) {
    T::parameters(*this, value);
  }

  /// The schema of the struct that was visited.
  Json take();

  /// A reference to the definition of T, which is made on first use; structs without a schema_name
  /// are written out in place.
  template <class T>
  Json reference() {
    if constexpr (requires { T::schema_name; }) {
      const std::string name(T::schema_name);
      if (!definitions_.contains(name)) {
        definitions_[name] = nullptr;  // keeps its place in the order
        Json made = describe<T>();
        definitions_[name] = std::move(made);
      }
      return {{"$ref", "#/definitions/" + name}};
    } else {
      return describe<T>();
    }
  }
  template <class T>
  Json describe() {
    SchemaVisitor inner(definitions_);
    const T defaults{};
    T::parameters(inner, defaults);
    Json object = inner.take();
    if constexpr (requires { T::shorthand_key; }) {
      Json bare = inner.properties_[std::string(T::shorthand_key)];
      return {{"anyOf", Json::array({std::move(bare), std::move(object)})}};
    }
    return object;
  }

 private:
  /// A struct with the one member that a default is asked of.
  template <class T>
  struct One {
    const T& value;
    template <class Visitor, class Self>
    static void parameters(Visitor& v, Self& d) {
      v.field(d.value, {.name = "v"});
    }
  };

  template <class T>
  void alternative(const Parameter& p) {
    SchemaVisitor inner(definitions_);
    const T defaults{};
    T::parameters(inner, defaults);
    Json properties = {{std::string(p.name), {{"const", std::string(type_name_of<T>())}}}};
    for (const auto& item : inner.properties_.items()) properties[item.key()] = item.value();
    inner.required_.insert(inner.required_.begin(), std::string(p.name));
    alternatives_.push_back({std::move(properties), std::move(inner.required_)});
  }
  void put(const Parameter& p, Json schema);

  static Json number(const Parameter& declared, const char* type);
  static Json array(Json item, size_t count);
  static Json leaf(double, const Parameter& p) { return number(p, "number"); }
  static Json leaf(const Varying&, const Parameter& p) {
    Json out = number(p, "number");
    out["anyOf"].push_back({{"type", "array"}, {"items", array({{"type", "number"}}, 2)}});
    return out;
  }
  static Json leaf(int, const Parameter& p) { return number(p, "integer"); }
  static Json leaf(uint64_t, const Parameter& p);
  static Json leaf(bool, const Parameter&) { return {{"type", "boolean"}}; }
  static Json leaf(const std::string&, const Parameter& p);
  static Json leaf(const Vec3&, const Parameter& p) { return array(number(p, "number"), 3); }
  static Json leaf(const Quat&, const Parameter& p) { return array(number(p, "number"), 4); }
  static Json leaf(const std::array<int, 3>&, const Parameter& p) {
    return array(number(p, "integer"), 3);
  }
  static Json leaf(const Colour&, const Parameter&) { return {{"$ref", "#/definitions/colour"}}; }
  static Json leaf(const TickRate&, const Parameter& p);
  template <class E>
  requires std::is_enum_v<E>
  static Json leaf(E, const Parameter&) {
    Json names = Json::array();
    for (const auto& [name, value] : EnumNames<E>::values) names.push_back(std::string(name));
    return {{"enum", std::move(names)}};
  }
  template <class T>
  static Json leaf(const std::optional<T>&, const Parameter& p) {
    return leaf(T{}, p);
  }
  template <class T>
  static Json leaf(const std::vector<T>&, const Parameter& p) {
    return {{"type", "array"}, {"items", leaf(T{}, p)}};
  }

  struct Alternative {
    Json properties;
    std::vector<std::string> required;
  };
  Json& definitions_;
  Json properties_ = Json::object();
  std::vector<std::string> required_;
  std::vector<Alternative> alternatives_;
};

}  // namespace tumble
