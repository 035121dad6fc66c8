#include "engine/scene/outline/outline_edits.hpp"

#include "engine/scene/description/material.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/saving/definition_json.hpp"
#include "engine/scene/visitors/json_text.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

Error outline_refusal(std::string why) {
  return {ErrorCode::invalid_argument, std::move(why), {}, {}};
}

Result<JsonNode> tree_of(const std::string& text) {
  FaultList faults;
  auto tree = parse_json(text, "", faults);
  if (!tree) return to_error(faults.sorted());
  return *std::move(tree);
}

bool is_spaced(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}
std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_spaced(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_spaced(text.back())) text.remove_suffix(1);
  return text;
}

std::string first_value(const JsonNode& scene, const Member& what);

/// A number that means as little as possible: the default, else 0 where that may be, else 1.
std::string first_number(const Member& what) {
  if (!what.fallback.empty()) return what.fallback;
  const bool zero = what.min < 0 || (what.min == 0 && !what.exclusive_min);
  const double least = zero && what.max >= 0 ? 0 : std::clamp(1.0, what.min, what.max);
  return one_line(Json(least == std::floor(least) ? Json(int64_t(least)) : Json(least)));
}

std::string first_vector(const Member& what) {
  if (!what.fallback.empty()) return what.fallback;
  const std::string number = first_number(what);
  std::string out = what.size == 4 ? "1" : number;  // a quaternion: no turn
  for (size_t i = 1; i < what.size; ++i) out += ", " + (what.size == 4 ? "0" : number);
  return "[" + out + "]";
}

std::string first_text(const JsonNode& scene, const Member& what) {
  if (what.refers_to.empty()) return what.fallback.empty() ? "\"\"" : what.fallback;
  const auto names = names_in(scene, what.refers_to);
  // A body with copies cannot stand where one is meant: its first copy follows it in the list.
  for (size_t i = 0; i < names.size(); ++i)
    if (i + 1 == names.size() || names[i + 1] != names[i] + "[0]") return Json(names[i]).dump();
  return "\"\"";
}

/// With all keys that it needs; what it needs beside single keys its own check() knows.
std::string first_object(const JsonNode& scene, const Member& what) {
  if (!what.refers_to.empty()) return first_text(scene, what);
  std::string out;
  for (const Member& member : members_of(*what.type, nullptr)) {
    if (!member.required) continue;
    out += fmt::format("{}\"{}\": {}", out.empty() ? "" : ", ", member.name,
                       first_value(scene, member));
  }
  return out.empty() ? "{}" : "{ " + out + " }";
}

std::string first_value(const JsonNode& scene, const Member& what) {
  switch (what.kind) {
    case MemberKind::number:
    case MemberKind::whole:
    case MemberKind::rate:
      return first_number(what);
    case MemberKind::truth:
      return what.fallback == "true" ? "false" : "true";
    case MemberKind::text:
      return first_text(scene, what);
    case MemberKind::choice:
      return !what.fallback.empty() ? what.fallback
             : what.names.empty()   ? "\"\""
                                    : Json(what.names[0]).dump();
    case MemberKind::vector:
      return first_vector(what);
    case MemberKind::colour:
      return what.fallback.empty() ? "\"orange\"" : what.fallback;
    case MemberKind::values:
      return what.fallback.size() > 2 ? what.fallback : "[" + first_value(scene, *what.item) + "]";
    case MemberKind::object:
      return first_object(scene, what);
    case MemberKind::list: {
      Member item = what;
      item.kind = MemberKind::object;
      item.refers_to.clear();
      return "[" + first_object(scene, item) + "]";
    }
    case MemberKind::map:
      return "{}";
  }
  return "null";
}

/// Puts a value where the declarations say; what is written in short on the way is written out.
Result<std::string> put(std::string text, const ScenePath& path, std::string_view value) {
  for (;;) {
    const auto tree = tree_of(text);
    if (!tree) return tree.error();
    const auto place = place_of(*tree, path);
    if (!place) return outline_refusal(text_of(path) + ": there is no such place in a scene");
    JsonTextEdit edit(std::move(text));
    if (place->first) {
      // As it is written, with its comments.
      const auto& [short_one, before, after] = *place->first;
      const auto said = edit.value(short_one);
      const std::string whole = said ? fmt::format("{}{}{}", before, *said, after) : std::string();
      if (!said || !edit.set(short_one, whole))
        return outline_refusal(text_of(path) + ": cannot be written out");
      text = edit.text();
      continue;
    }
    const bool one_more = place->numbered && !place->node;
    const ScenePath around(place->in_text.begin(), place->in_text.end() - (one_more ? 1 : 0));
    const bool done = !one_more            ? edit.set(place->in_text, value)
                      : edit.value(around) ? edit.append(around, value)
                                           : edit.set(around, fmt::format("[{}]", value));
    if (!done) return outline_refusal(text_of(path) + ": there is no place for it in the file");
    return edit.text();
  }
}

/// Whether the reader finds something wrong at or below a path, where it can read the text.
bool has_faults(const std::string& text, const std::string& path) {
  const SceneRead read = read_scene(text, "");
  return std::ranges::any_of(read.faults, [&](const Fault& fault) {
    return fault.path.starts_with(path) &&
           (fault.path.size() == path.size() || fault.path[path.size()] == '.' ||
            fault.path[path.size()] == '[');
  });
}

/// An object of which one key at least must be there, whichever: with the first that will do.
std::string completed(std::string text, const ScenePath& path) {
  const std::string name = text_of(path);
  if (!has_faults(text, name)) return text;
  const auto tree = tree_of(text);
  const auto place = tree ? place_of(*tree, path) : std::nullopt;
  if (!place || place->what.kind != MemberKind::object || !place->node) return text;
  if (!place->node->is(JsonNode::Kind::object)) return text;
  for (const Member& member : members_of(*place->what.type, place->node)) {
    if (place->node->find(member.name)) continue;
    auto with = put(text, path / member.name, first_value(*tree, member));
    if (with && !has_faults(*with, name)) return *std::move(with);
  }
  return text;
}

/// After `type` has become another: only what that knows stays, and what it needs comes.
Result<std::string> after_choice(std::string text, const ScenePath& object) {
  const auto tree = tree_of(text);
  if (!tree) return tree.error();
  const auto place = place_of(*tree, object);
  if (!place || !place->node) return text;
  const auto members = members_of(*place->what.type, place->node);
  JsonTextEdit edit(std::move(text));
  for (const std::string& key : place->node->keys)
    if (std::ranges::find(members, key, &Member::name) == members.end())
      edit.remove(place->in_text / key);
  for (const Member& member : members)
    if (member.required && !place->node->find(member.name))
      edit.set(place->in_text / member.name, first_value(*tree, member));
  return edit.text();
}

/// What a name still means after the scene has left out its own thing of that name.
bool comes_with_tumble(const std::string& list, const std::string& name) {
  return list == "materials" && std::ranges::any_of(built_in_materials(), [&](const auto& known) {
           return known.first == name;
         });
}

}  // namespace

Result<std::string> with_value(const std::string& text, const ScenePath& path,
                               std::string_view value) {
  auto changed = put(text, path, value);
  if (!changed) return changed;
  const auto tree = tree_of(*changed);
  if (!tree) return tree.error();
  const auto place = place_of(*tree, path);
  if (!place || !place->what.selects) return changed;
  auto fitting = after_choice(*std::move(changed), outer_path(path));
  if (!fitting) return fitting;
  return completed(*std::move(fitting), outer_path(path));
}

Result<std::string> with_added(const std::string& text, const ScenePath& path) {
  const auto tree = tree_of(text);
  if (!tree) return tree.error();
  const auto place = place_of(*tree, path);
  if (!place) return outline_refusal(text_of(path) + ": there is no such place in a scene");
  if (place->node) return outline_refusal(text_of(path) + " is there already");
  Member what = place->what;
  // What is defined here is not one that has this name already.
  if (place->named) what.refers_to.clear();
  auto changed = put(text, path, first_value(*tree, what));
  if (!changed) return changed;
  return completed(*std::move(changed), path);
}

Result<std::string> without(const std::string& text, const ScenePath& path,
                            std::vector<TakenAlong>& along) {
  const auto tree = tree_of(text);
  if (!tree) return tree.error();
  const auto place = place_of(*tree, path);
  if (!place || !place->node) return outline_refusal(text_of(path) + " is not there");
  if (place->what.required && !place->named && !place->numbered)
    return outline_refusal(text_of(path) + " must be there");
  JsonTextEdit edit(text);
  ScenePath gone = place->in_text;
  if (place->numbered) {
    // The last of several takes the key along, which would say nothing.
    const auto several = place_of(*tree, outer_path(path));
    const bool alone = !several->node->is(JsonNode::Kind::array);
    // Without brackets the text of the item is that of the list.
    if (alone && several->what.required) return outline_refusal(text_of(path) + " must be there");
    const bool last = alone || several->node->items.size() == 1;
    if (last && !several->what.required) gone = several->in_text;
  }
  if (!edit.remove(gone)) return outline_refusal(text_of(path) + ": it cannot be left out");
  if (place->named && path.size() == 2 && !comes_with_tumble(path[0].key, path[1].key))
    along = drop_dependents(edit, path[0].key, path[1].key);
  return edit.text();
}

Result<std::string> with_moved(const std::string& text, const ScenePath& path, int places) {
  const auto tree = tree_of(text);
  if (!tree) return tree.error();
  const auto place = place_of(*tree, path);
  if (!place || !place->node || !place->numbered)
    return outline_refusal(text_of(path) + " is not there");
  JsonTextEdit edit(text);
  ScenePath at = place->in_text;
  for (; places != 0; places += places < 0 ? 1 : -1) {
    if (places < 0 && at.back().index.value_or(0) == 0)
      return outline_refusal(text_of(path) + " is the first already");
    if (places < 0) --*at.back().index;
    if (!edit.swap_with_next(at)) return outline_refusal(text_of(path) + " is the last already");
    if (places > 0) ++*at.back().index;
  }
  return edit.text();
}

std::string free_name(const JsonNode& scene, std::string_view list, std::string_view stem) {
  const JsonNode* all = scene.find(list);
  std::string name(stem);
  for (int n = 2; all && all->find(name); ++n) name = fmt::format("{}_{}", stem, n);
  return name;
}

Result<Declared> with_parameter(const std::string& text, const ScenePath& path) {
  const auto tree = tree_of(text);
  if (!tree) return tree.error();
  const auto place = place_of(*tree, path);
  if (!place || !place->node || !place->node->is_number() || !place->what.is_number())
    return outline_refusal(text_of(path) + " is no plain number");
  std::string stem;
  for (auto step = path.rbegin(); step != path.rend() && stem.empty(); ++step)
    if (!step->index) stem = step->key;
  const std::string name = free_name(*tree, "parameters", stem);
  JsonTextEdit edit(text);
  const std::string value(*edit.value(place->in_text));
  if (!edit.set(place->in_text, fmt::format("\"${}\"", name)) ||
      !edit.set(ScenePath{} / "parameters" / name, value))
    return outline_refusal(text_of(path) + ": there is no place for a parameter in the file");
  return Declared{edit.text(), name};
}

Result<std::string> typed_value(const Member& what, std::string_view typed) {
  typed = trimmed(typed);
  // A bare value for an object is one of the key that it stands for.
  if (what.kind == MemberKind::object && what.type) {
    const auto members = members_of(*what.type, nullptr);
    const auto meant = std::ranges::find(members, what.type->shorthand_key, &Member::name);
    if (meant != members.end() && meant->kind != MemberKind::object)
      return typed_value(*meant, typed);
  }
  const bool text = what.kind == MemberKind::text || what.kind == MemberKind::choice ||
                    what.kind == MemberKind::object || what.kind == MemberKind::colour;
  if (text && !(what.kind == MemberKind::colour && typed.starts_with('[')))
    return Json(std::string(typed)).dump();
  if (typed.empty()) return outline_refusal("a value is missing");
  if (typed.front() == '=' || typed.front() == '$') return Json(std::string(typed)).dump();
  FaultList faults;
  const std::string value(typed);
  const auto parsed = parse_json(value, "", faults);
  if (parsed && (parsed->is_number() || parsed->is(JsonNode::Kind::array) ||
                 parsed->is(JsonNode::Kind::boolean)))
    return value;
  if (what.kind == MemberKind::rate) return Json(value).dump();
  // Who types "2*pi" or "sin(t)" means an expression.
  return Json("= " + value).dump();
}

std::string shown_value(std::string_view json) {
  if (!json.starts_with('"')) return std::string(json);
  return Json::parse(json).get<std::string>();
}

}  // namespace tumble
