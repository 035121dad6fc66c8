#include "engine/scene/outline/outline.hpp"

#include "engine/dynamics/bodies/body.hpp"
#include "engine/scene/description/material.hpp"
#include "engine/scene/visitors/object_writer.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

namespace tumble {
namespace {

using Kind = JsonNode::Kind;

constexpr size_t longest_words = 40;  ///< letters that a line of a panel has room for, about

std::string short_text(std::string text) {
  return text.size() <= longest_words ? text : text.substr(0, longest_words - 3) + "...";
}

/// The word of the declarations for what an object is, where it says one.
std::string kind_of(const JsonNode& object) {
  for (const char* key : {"type", "kind"})
    if (const JsonNode* said = object.find(key); said && said->is(Kind::string))
      return short_text(said->string);
  return {};
}

/// What stands in few words for something with parts.
std::string summary_of(const Member& what, const JsonNode& node) {
  if (!node.is(Kind::object) && !node.is(Kind::array)) return one_line(node);
  if (what.kind == MemberKind::values) return short_text(one_line(node));
  if (what.kind == MemberKind::list) {
    const size_t count = node.is(Kind::array) ? node.items.size() : 1;
    return count == 1 ? "1 item" : fmt::format("{} items", count);
  }
  if (what.kind == MemberKind::map) {
    std::string names;
    for (const std::string& name : node.keys) {
      if (names.size() > longest_words) break;
      names += (names.empty() ? "" : ", ") + name;
    }
    return short_text(std::move(names));
  }
  return kind_of(node);
}

std::string joined(std::span<const std::string> words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

/// A value in few words: "0.5", "0, 1, 0"; of objects what they are, or what they speak of. "": it
/// takes more than that.
std::string plain_value(const JsonNode& node) {
  if (node.is(Kind::object)) {
    std::string kind = kind_of(node);
    return kind.empty() ? short_text(joined(node.keys)) : kind;
  }
  if (node.is(Kind::string)) return short_text(node.string);
  if (!node.is(Kind::array)) return one_line(node);
  std::vector<std::string> items;
  for (const JsonNode& item : node.items) {
    items.push_back(item.is(Kind::object) ? kind_of(item) : plain_value(item));
    if (items.back().empty() || item.is(Kind::array)) return {};
  }
  return short_text(joined(items));
}

/// The keys of which all items of a list say the same.
std::vector<std::string> common_keys(std::span<const JsonNode> items) {
  std::vector<std::string> out;
  if (items.empty() || !items[0].is(Kind::object)) return out;
  for (size_t k = 0; k < items[0].keys.size(); ++k) {
    const std::string& key = items[0].keys[k];
    const std::string text = one_line(items[0].items[k]);
    if (std::ranges::all_of(items, [&](const JsonNode& item) {
          const JsonNode* there = item.is(Kind::object) ? item.find(key) : nullptr;
          return there && one_line(*there) == text;
        }))
      out.push_back(key);
  }
  return out;
}

/// The values of an object that can be said in few words: those that its neighbours in a list do
/// not have in common with it, or all where there are none of these. Words come before numbers.
std::vector<ToldValue> told_of(const Member& what, const JsonNode& object,
                               const std::vector<std::string>& common) {
  if (what.kind != MemberKind::object || !what.type || !object.is(Kind::object)) return {};
  const std::string kind = kind_of(object);
  std::vector<ToldValue> all, telling;
  for (const Member& member : members_of(*what.type, &object)) {
    const JsonNode* value = object.find(member.name);
    std::string words = value ? plain_value(*value) : std::string();
    const bool is_kind = !kind.empty() && (member.name == "type" || member.name == "kind");
    if (words.empty() || is_kind) continue;
    const bool chosen = member.kind == MemberKind::choice ||
                        (member.has_parts() && member.kind != MemberKind::values);
    all.push_back({member.name, member.unit, std::move(words), chosen});
    if (std::ranges::find(common, member.name) == common.end()) telling.push_back(all.back());
  }
  if (!telling.empty()) all = std::move(telling);
  // What something is says more than where it is.
  std::stable_partition(all.begin(), all.end(), [](const ToldValue& v) { return v.choice; });
  return all;
}

Member item_of(const Member& several, std::string name) {
  Member item;
  if (several.item) {
    item = *several.item;
  } else {
    item.kind = MemberKind::object;
    item.type = several.type;
    item.unit = several.unit;
    item.doc = several.doc;
    if (several.type && !several.type->shorthand_key.empty() && several.name == "materials")
      item.refers_to = several.name;
  }
  item.name = std::move(name);
  return item;
}

/// The place of a key of an object, which may be written as the one value that stands for it.
std::optional<Place> key_of(const Place& object, const std::string& key) {
  const StructType& type = *object.what.type;
  const bool bare = object.node && !object.node->is(Kind::object);
  const auto members = members_of(type, bare ? nullptr : object.node);
  const auto found = std::ranges::find(members, key, &Member::name);
  if (found == members.end()) return std::nullopt;
  Place out;
  out.what = *found;
  out.in_text = object.in_text / key;
  if (bare && key == type.shorthand_key) {
    out.node = object.node;
    out.in_text = object.in_text;
  } else if (bare && !type.shorthand_key.empty()) {
    out.first = {object.in_text, fmt::format("{{ \"{}\": ", type.shorthand_key), " }"};
  } else if (object.node) {
    out.node = object.node->find(key);
  }
  return out;
}

/// The place of an item, of which one alone may stand without brackets.
std::optional<Place> item_at(const Place& list, size_t index) {
  const JsonNode* node = list.node;
  const bool array = node && node->is(Kind::array);
  const size_t count = !node ? 0 : array ? node->items.size() : 1;
  if (index > count) return std::nullopt;
  Place out;
  out.what = item_of(list.what, fmt::format("[{}]", index));
  out.numbered = true;
  out.in_text = at_index(list.in_text, index);
  if (array && index < count) out.node = &node->items[index];
  if (node && !array) {
    if (index == 0) {
      out.node = node;
      out.in_text = list.in_text;
    } else {
      out.first = {list.in_text, "[", "]"};
    }
  }
  return out;
}

/// One of the numbers of a vector that is there.
std::optional<Place> number_at(const Place& vector, size_t index) {
  const bool there = vector.node && vector.node->is(Kind::array);
  if (!there || index >= vector.node->items.size()) return std::nullopt;
  Place out;
  out.what = vector.what;
  out.what.kind = MemberKind::number;
  out.what.required = true;
  out.node = &vector.node->items[index];
  out.in_text = at_index(vector.in_text, index);
  return out;
}

std::optional<Place> next_place(const Place& place, const PathStep& step) {
  std::optional<Place> out;
  switch (place.what.kind) {
    case MemberKind::object:
      if (!step.index) out = key_of(place, step.key);
      break;
    case MemberKind::map:
      if (step.index) break;
      out.emplace();
      out->what = item_of(place.what, step.key);
      out->named = true;
      out->node = place.node ? place.node->find(step.key) : nullptr;
      out->in_text = place.in_text / step.key;
      break;
    case MemberKind::list:
    case MemberKind::values:
      if (step.index) out = item_at(place, *step.index);
      break;
    case MemberKind::vector:
      if (step.index) out = number_at(place, *step.index);
      break;
    default:
      break;
  }
  // What must be written otherwise on the way must be so first.
  if (out && place.first) out->first = place.first;
  return out;
}

/// How often a body is there, as far as its description says it in numbers; 0: once.
bool has_copies(const JsonNode& body) {
  return body.find("repeat") != nullptr;
}

void collect_names(const JsonNode& scene, const Member& what, Outline& out) {
  const std::string& list = what.item ? what.item->refers_to : what.refers_to;
  if (list.empty() || !out.names_of(list).empty()) return;
  out.names.emplace_back(list, names_in(scene, list));
}

void add_key(Outline& out, const JsonNode& scene, Member what, const JsonNode* node,
             const std::vector<std::string>& common = {}) {
  OutlineKey key;
  key.what = std::move(what);
  if (node) {
    key.text = one_line(*node);
    if (key.what.has_parts()) key.summary = summary_of(key.what, *node);
    key.told = told_of(key.what, *node, common);
  }
  collect_names(scene, key.what, out);
  out.keys.push_back(std::move(key));
}

}  // namespace

std::string one_line(const JsonNode& node) {
  switch (node.kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return node.boolean ? "true" : "false";
    case Kind::integer:
      return fmt::format("{}{}", node.negative ? "-" : "", node.magnitude);
    case Kind::number:
      return fmt::format("{}", node.number);
    case Kind::string:
      return Json(node.string).dump();
    case Kind::array:
    case Kind::object:
      break;
  }
  const bool object = node.is(Kind::object);
  std::string out;
  for (size_t i = 0; i < node.items.size(); ++i) {
    if (i > 0) out += ", ";
    if (object) out += Json(node.keys[i]).dump() + ": ";
    out += one_line(node.items[i]);
  }
  if (!object) return "[" + out + "]";
  return out.empty() ? "{}" : "{ " + out + " }";
}

std::string text_of(const ScenePath& path) {
  std::string out;
  for (const PathStep& step : path)
    out += step.index ? fmt::format("[{}]", *step.index) : (out.empty() ? "" : ".") + step.key;
  return out;
}

std::optional<Place> place_of(const JsonNode& scene, const ScenePath& path) {
  std::optional<Place> place = Place{scene_member(), &scene, {}, false, false, {}};
  for (const PathStep& step : path) {
    place = next_place(*place, step);
    if (!place) return std::nullopt;
  }
  return place;
}

std::vector<std::string> names_in(const JsonNode& scene, std::string_view list) {
  std::vector<std::string> out;
  if (const JsonNode* all = scene.find(list))
    for (size_t i = 0; i < all->keys.size(); ++i) {
      out.push_back(all->keys[i]);
      if (list == "bodies" && has_copies(all->items[i])) out.push_back(all->keys[i] + "[0]");
    }
  if (list == "materials")
    for (const auto& [name, material] : built_in_materials())
      if (std::ranges::find(out, name) == out.end()) out.emplace_back(name);
  return out;
}

std::vector<std::string> Outline::names_of(std::string_view list) const {
  for (const auto& [of, all] : names)
    if (of == list) return all;
  return {};
}

Outline outline_of(const JsonNode& scene, ScenePath path) {
  std::optional<Place> place = place_of(scene, path);
  while (!path.empty() && (!place || !place->node || !place->what.has_parts())) {
    path.pop_back();
    place = place_of(scene, path);
  }
  Outline out;
  out.path = std::move(path);
  out.what = place->what;
  out.there = place->node != nullptr;
  out.named = place->named;
  out.numbered = place->numbered;
  const JsonNode& node = *place->node;
  if (out.what.kind == MemberKind::object) {
    const bool bare = !node.is(Kind::object);
    for (Member& member : members_of(*out.what.type, bare ? nullptr : &node)) {
      if (out.path.empty() && member.name == "tumble_scene") continue;  // the format, not the scene
      const JsonNode* value = !bare                                         ? node.find(member.name)
                              : member.name == out.what.type->shorthand_key ? &node
                                                                            : nullptr;
      add_key(out, scene, std::move(member), value);
    }
  } else if (out.what.kind == MemberKind::map) {
    for (size_t i = 0; i < node.keys.size(); ++i)
      add_key(out, scene, item_of(out.what, node.keys[i]), &node.items[i]);
  } else {
    const bool alone = !node.is(Kind::array);
    const std::span<const JsonNode> items = alone ? std::span(&node, 1) : std::span(node.items);
    const std::vector<std::string> common = common_keys(items);
    for (size_t i = 0; i < items.size(); ++i)
      add_key(out, scene, item_of(out.what, fmt::format("[{}]", i)), &items[i], common);
  }
  return out;
}

}  // namespace tumble
