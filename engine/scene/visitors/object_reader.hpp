#pragma once
#include "engine/scene/visitors/read_values.hpp"

#include <type_traits>
#include <variant>

namespace tumble {

/// Names in one object; looking them up is linear.
constexpr size_t max_names = 20000;

/// Visitor that fills a description struct from a JSON object: types, required and unknown keys.
/// Ranges are the validator's.
class ObjectReader {
 public:
  ObjectReader(ReadContext& context, const JsonNode& node, std::string path)
      : c_(context), node_(node), path_(std::move(path)) {}

  template <class T>
  void field(T& value, const Parameter& p) {
    if (const JsonNode* n = take(p)) read_value(c_, *n, at(p.name), value);
  }

  template <class T>
  void object(T& value, const Parameter& p) {
    if (const JsonNode* n = take(p)) read_object(c_, *n, at(p.name), value);
  }
  template <class T>
  void object(std::optional<T>& value, const Parameter& p) {
    if (const JsonNode* n = take(p)) read_object(c_, *n, at(p.name), value.emplace());
  }

  /// An array of objects, or a single one.
  template <class T>
  void list(std::vector<T>& values, const Parameter& p) {
    const JsonNode* n = take(p);
    if (!n) return;
    const std::string path = at(p.name);
    bool single = n->is(JsonNode::Kind::object);
    if constexpr (requires { T::shorthand_key; }) single = !n->is(JsonNode::Kind::array);
    if (single) return read_object(c_, *n, path + "[0]", values.emplace_back());
    if (!n->is(JsonNode::Kind::array))
      return c_.fault(*n, path, "must be an array of objects, got " + brief(*n));
    values.reserve(n->items.size());
    for (size_t i = 0; i < n->items.size(); ++i)
      read_object(c_, n->items[i], path + "[" + std::to_string(i) + "]", values.emplace_back());
  }

  template <class T>
  void map(NamedList<T>& values, const Parameter& p) {
    const JsonNode* n = take(p);
    if (!n) return;
    if (!n->is(JsonNode::Kind::object))
      return c_.fault(*n, at(p.name),
                      "must be an object that maps names to values, got " + brief(*n));
    if (n->items.size() > max_names)
      return c_.fault(*n, at(p.name),
                      "has " + std::to_string(n->items.size()) + " names; at most " +
                          std::to_string(max_names) +
                          " are read (repeat makes many copies of one)");
    for (size_t i = 0; i < n->items.size(); ++i) {
      const std::string path = at(p.name) + "." + n->keys[i];
      check_name(n->items[i], path, n->keys[i], std::is_same_v<T, CopyDescription>);
      T& value = values.add(n->keys[i]);
      read_object(c_, n->items[i], path, value);
      if constexpr (std::is_same_v<T, ParameterDescription>)
        c_.parameters.emplace_back(n->keys[i], value.value);
    }
  }

  /// The alternative whose type_name the key p.name gives; its members lie in the same object.
  template <class... Ts>
  void one_of(std::variant<Ts...>& value, const Parameter& p) {
    static const std::vector<std::string> names{std::string(type_name_of<Ts>())...};
    const JsonNode* n = take(p);
    const auto chosen = n ? read_name(c_, *n, at(p.name), p.name, names) : std::nullopt;
    if (!chosen) {
      lenient_ = true;  // what the other keys mean is unknown
      return;
    }
    size_t i = 0;
    ((i++ == *chosen ? (void)Ts::parameters(*this, value.template emplace<Ts>()) : void()), ...);
  }

  /// Members of a part that lie in the same object.
  template <class T>
  void part(T& value) {
    T::parameters(*this, value);
  }

  /// The one value that a bare (not object) node stands for.
  void set_shorthand(std::string_view key) { shorthand_ = key; }
  /// Faults for keys that nobody asked for.
  void finish();

  template <class T>
  static void read_object(ReadContext& c, const JsonNode& node, const std::string& path, T& value) {
    ObjectReader reader(c, node, path);
    if (!node.is(JsonNode::Kind::object)) {
      if constexpr (requires { T::shorthand_key; }) {
        reader.set_shorthand(T::shorthand_key);
      } else {
        return c.fault(node, path, "must be an object, got " + brief(node));
      }
    }
    T::parameters(reader, value);
    reader.finish();
  }

 private:
  /// The node of a key, or null (with a fault when it is required).
  const JsonNode* take(const Parameter& p);
  std::string at(std::string_view key) const;
  void check_name(const JsonNode& node, const std::string& path, const std::string& name,
                  bool number);

  ReadContext& c_;
  const JsonNode& node_;
  std::string path_;
  std::string_view shorthand_;
  std::vector<std::string> known_;
  bool lenient_ = false;
};

}  // namespace tumble
