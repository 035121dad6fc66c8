#include "engine/scene/visitors/object_reader.hpp"

#include "engine/core/text.hpp"
#include "engine/scene/description/body.hpp"
#include "engine/scene/description/parameter.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Visitor that fills the members of one object.
class ObjectReader final : public StructVisitor {
 public:
  ObjectReader(ReadContext& context, const JsonNode& node, std::string path,
               std::string_view shorthand)
      : c_(context), node_(node), path_(std::move(path)), shorthand_(shorthand) {}

  void field(const Leaf& value, const Parameter& p) override {
    if (const JsonNode* n = take(p)) read_value(c_, *n, at(p.name), value);
  }
  void object(const StructRef& value, const Parameter& p) override {
    if (const JsonNode* n = take(p)) read_object(c_, *n, at(p.name), value);
  }
  void object(const OptionalRef& value, const Parameter& p) override {
    if (const JsonNode* n = take(p)) read_object(c_, *n, at(p.name), value.emplace());
  }
  void list(const ListRef& values, const Parameter& p) override;
  void map(const MapRef& values, const Parameter& p) override;
  void one_of(const VariantRef& value, const Parameter& p) override;
  void part(const StructRef& value) override { value.type->parameters(value.object, *this); }

  /// Reports keys that no member has.
  void finish();

 private:
  /// The node of a key, or null (with a fault if it is required).
  const JsonNode* take(const Parameter& p);
  std::string at(std::string_view key) const;
  void check_name(const JsonNode& node, const std::string& path, const std::string& name,
                  bool number);

  ReadContext& c_;
  const JsonNode& node_;
  std::string path_;
  std::string_view shorthand_;  ///< key of the member that is meant if the node is not an object
  std::vector<std::string> known_;
  bool lenient_ = false;
};

/// Reads an array of objects, or a single one.
void ObjectReader::list(const ListRef& values, const Parameter& p) {
  const JsonNode* n = take(p);
  if (!n) return;
  const std::string path = at(p.name);
  const bool array = n->is(JsonNode::Kind::array);
  const bool single =
      values.type->item->shorthand_key.empty() ? n->is(JsonNode::Kind::object) : !array;
  if (single) return read_object(c_, *n, path + "[0]", values.append());
  if (!array) return c_.fault(*n, path, "must be an array of objects, got " + brief(*n));
  // Whoever writes it means that nothing is drawn.
  if (n->items.empty() && values.type->item == &struct_type<DrawnDescription>())
    return c_.fault(
        *n, path,
        "is empty, so that the shapes would be drawn: leave it out, or hide the body by "
        "\"look\": { \"visible\": false }");
  values.type->reserve(values.list, n->items.size());
  for (size_t i = 0; i < n->items.size(); ++i)
    read_object(c_, n->items[i], path + "[" + std::to_string(i) + "]", values.append());
}

void ObjectReader::map(const MapRef& values, const Parameter& p) {
  const JsonNode* n = take(p);
  if (!n) return;
  if (!n->is(JsonNode::Kind::object))
    return c_.fault(*n, at(p.name),
                    "must be an object that maps names to values, got " + brief(*n));
  if (n->items.size() > max_names)
    return c_.fault(*n, at(p.name),
                    "has " + std::to_string(n->items.size()) + " names; at most " +
                        std::to_string(max_names) + " are read (repeat makes many copies of one)");
  const StructType* item = values.type->item;
  for (size_t i = 0; i < n->items.size(); ++i) {
    const std::string path = at(p.name) + "." + n->keys[i];
    check_name(n->items[i], path, n->keys[i], item == &struct_type<CopyDescription>());
    const StructRef value = values.add(n->keys[i]);
    read_object(c_, n->items[i], path, value);
    if (item == &struct_type<ParameterDescription>())
      c_.parameters.emplace_back(n->keys[i],
                                 static_cast<const ParameterDescription*>(value.object)->value);
  }
}

void ObjectReader::one_of(const VariantRef& value, const Parameter& p) {
  std::vector<std::string> names;
  for (const StructType* type : value.type->alternatives) names.emplace_back(type->type_name);
  const JsonNode* n = take(p);
  const auto chosen = n ? read_name(c_, *n, at(p.name), p.name, names) : std::nullopt;
  if (chosen)
    part(value.emplace(*chosen));
  else
    lenient_ = true;  // the meaning of the other keys is unknown
}

std::string ObjectReader::at(std::string_view key) const {
  if (!shorthand_.empty()) return path_;
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

const JsonNode* ObjectReader::take(const Parameter& p) {
  known_.emplace_back(p.name);
  if (!shorthand_.empty()) return p.name == shorthand_ ? &node_ : nullptr;
  const JsonNode* found = node_.find(p.name);
  if (!found && p.required)
    c_.fault(node_, path_, "the key '" + std::string(p.name) + "' is missing");
  return found;
}

void ObjectReader::check_name(const JsonNode& node, const std::string& path,
                              const std::string& name, bool number) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  if (number) {
    if (name.empty() || name.size() > 9 || !std::all_of(name.begin(), name.end(), digit))
      c_.fault(node, path, "'" + name + "' is not the number of a copy");
    return;
  }
  const bool good =
      !name.empty() && letter(name[0]) && name.size() <= 64 &&
      std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || digit(c); });
  if (!good)
    c_.fault(node, path,
             "'" + name + "' is not a name: letters, digits and _, not starting with a digit");
}

void ObjectReader::finish() {
  if (lenient_ || !shorthand_.empty()) return;
  for (size_t i = 0; i < node_.keys.size() && i < node_.items.size(); ++i) {
    const std::string& key = node_.keys[i];
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    if (path_.empty() && key == "$schema") continue;
    c_.fault(node_.items[i], at(key), unknown_name("key", key, known_));
  }
}

}  // namespace

void read_object(ReadContext& c, const JsonNode& node, const std::string& path,
                 const StructRef& out) {
  const bool bare = !node.is(JsonNode::Kind::object);
  if (bare && out.type->shorthand_key.empty())
    return c.fault(node, path, "must be an object, got " + brief(node));
  ObjectReader reader(c, node, path, bare ? out.type->shorthand_key : std::string_view());
  reader.part(out);
  reader.finish();
}

}  // namespace tumble
