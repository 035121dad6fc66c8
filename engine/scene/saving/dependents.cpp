#include "engine/scene/saving/dependents.hpp"

#include "engine/math/expression.hpp"
#include "engine/scene/repetition.hpp"
#include "engine/scene/saving/naming_keys.hpp"

#include <algorithm>
#include <cctype>
#include <deque>
#include <functional>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Path = JsonTextEdit::Path;

/// Keys whose text, or texts, are expressions over quantities: "bodies.ball.position.y > 1".
constexpr std::string_view expression_keys[] = {"holds", "assertions", "plot", "quantity"};
/// Keys that can be removed from their object together with their value.
constexpr std::string_view loose_keys[] = {"follow",   "couple", "camera", "plot",
                                           "question", "pins",   "events", "rope",
                                           "material", "like",   "drawn"};

template <class Keys>
bool among(const Keys& keys, std::string_view key) {
  return std::ranges::find(keys, key) != std::end(keys);
}

/// What was removed: "ball" stands for its copies, too.
struct Gone {
  std::string list, name;

  bool named(std::string_view text) const {
    return text == name || (text.starts_with(name) && text.substr(name.size()).starts_with('['));
  }
  bool in_quantity(const std::string& quantity) const {
    const std::string head = (list == "forces" ? "ledger.forces." : list + ".") + name;
    if (quantity.starts_with(head) && quantity.size() > head.size() &&
        (quantity[head.size()] == '.' || quantity[head.size()] == '['))
      return true;
    if (list == "particles") return of_weave(quantity);
    return list == "bodies" && quantity.starts_with("sensors.") &&
           quantity.ends_with(".holds." + name);
  }
  /// Whether a quantity belongs to a force that a particle system makes for itself: "flag.cloth".
  bool of_weave(const std::string& quantity) const {
    constexpr std::string_view made[] = {"cloth", "net", "rope", "springs"};
    return std::ranges::any_of(made, [&](std::string_view kind) {
      const std::string head = fmt::format("ledger.forces.{}.{}", name, kind);
      return quantity.starts_with(head) &&
             (quantity.size() == head.size() || quantity[head.size()] == '.' ||
              quantity[head.size()] == '[');
    });
  }
  bool in_expression(const std::string& text) const {
    const auto parsed = Expression::parse(text);
    return parsed &&
           std::ranges::any_of(parsed->names(), [this](const auto& n) { return in_quantity(n); });
  }
};

/// Searches for the first text that refers to what was removed.
class Search {
 public:
  explicit Search(const Gone& gone) : gone_(gone) {}
  /// Calls `each` for every text value, with its key.
  using Each = std::function<void(const Path&, std::string_view key, const std::string& text)>;
  void all_in(const JsonNode& root, const Each& each) {
    each_ = &each;
    (void)in(root);
    each_ = nullptr;
  }

  std::optional<Path> in(const JsonNode& root) {
    found_.clear();
    for (size_t i = 0; i < root.keys.size(); ++i) {
      // The keys among the definitions are names, which have no meaning as keys here.
      if (look(root.items[i], root.keys[i], {{root.keys[i], {}}}, 0)) return found_;
    }
    return std::nullopt;
  }

 private:
  bool look(const JsonNode& node, std::string_view key, Path path, int depth) {
    if (node.is(JsonNode::Kind::string)) {
      if (!names(node.string, key, path)) return false;
      if (each_) (*each_)(path, key, node.string);
      if (each_) return false;
      found_ = std::move(path);
      return true;
    }
    for (size_t i = 0; i < node.items.size(); ++i) {
      Path own = path;
      const bool object = node.is(JsonNode::Kind::object);
      if (object)
        own.push_back({node.keys[i], {}});
      else
        own.push_back({{}, i});
      if (look(node.items[i], object ? std::string_view(node.keys[i]) : key, own, depth + 1))
        return true;
    }
    return false;
  }
  bool names(const std::string& text, std::string_view key, const Path& path) const {
    // Bodies, of which there may be many, name surfaces and meshes only.
    const bool made_of = gone_.list == "materials" || gone_.list == "meshes";
    if (!made_of && (path[0].key == "bodies" || path[0].key == "materials")) return false;
    // A bare name in the place of a material stands for {"like": name}.
    if (path[0].key == "materials" && path.size() == 2) key = "like";
    if (among(expression_keys, key)) return gone_.in_expression(text);
    if (path.size() < 2) return false;
    // For sensors, joints and forces; the names that a robot uses are in other places.
    return std::ranges::any_of(naming_keys, [&](const NamingKey& k) {
      return k.key == key && k.list == gone_.list && gone_.named(text);
    });
  }

  const Gone& gone_;
  Path found_;
  const Each* each_ = nullptr;
};

const JsonNode* node_at(const JsonNode& root, std::span<const PathStep> path) {
  const JsonNode* node = &root;
  for (const PathStep& step : path) {
    if (step.index)
      node = *step.index < node->items.size() ? &node->items[*step.index] : nullptr;
    else
      node = node->find(step.key);
    if (!node) return nullptr;
  }
  return node;
}

bool says(const JsonNode& object, std::string_view key, std::string_view value) {
  const JsonNode* member = object.find(key);
  return member && member->string == value;
}

/// Whether a definition still has a purpose without this member, which would be an empty list of
/// names.
bool does_without(const JsonNode& object, std::string_view key) {
  for (const auto& [one, other] : {std::pair("bodies", "particles"), {"particles", "bodies"}})
    if (const JsonNode* rest = object.find(other);
        key == one && rest && (!rest->items.empty() || !rest->string.empty()))
      return true;
  // An event tells of which particles the death is meant.
  const JsonNode* dies = object.find("dies");
  return key == "emitter" && dies && dies->boolean && says(object, "event", "collision");
}

/// A sink of particles and bodies, which must not take all particles when it has no names of
/// systems any more.
bool takes_bodies_too(const JsonNode& root, const Path& path) {
  if (path.size() < 3 || path[0].key != "sinks" || path[2].key != "particles") return false;
  const JsonNode* sink = node_at(root, std::span(path).first(2));
  return sink && (says(*sink, "takes", "both") || says(*sink, "takes", "bodies"));
}

/// What must be removed for a text at `path` that refers to what was removed: a prefix of that
/// path.
Path to_be_removed(const JsonNode& root, Path path) {
  const auto around = [&] { return node_at(root, std::span(path).first(path.size() - 1)); };
  // One of several names is removed alone.
  if (path.back().index) {
    if (around()->items.size() > 1) return path;
    path.pop_back();
  }
  if (path.size() > 1 && !path.back().index &&
      (does_without(*around(), path.back().key) || takes_bodies_too(root, path)))
    return path;
  constexpr std::string_view unnamed[] = {"lesson", "microscope", "assertions"};
  while (path.size() > 1) {
    if (!path.back().index && among(loose_keys, path.back().key)) return path;
    const bool of_map = path.size() == 2 && !path[1].index && !among(unnamed, path[0].key);
    if (of_map) return path;
    // An item of a list of objects; the path of a rope needs two.
    if (path.back().index && around()->items.size() > (path[path.size() - 2].key == "path" ? 2 : 1))
      return path;
    path.pop_back();
  }
  return path;
}

std::string text_of(std::span<const PathStep> path) {
  std::string out;
  for (const PathStep& step : path)
    out += step.index ? fmt::format("[{}]", *step.index) : (out.empty() ? "" : ".") + step.key;
  return out;
}

/// A quick test whether a text could contain this name: for most copies of a body it does not.
/// Escape sequences may hide a name, and count as if they did.
bool may_name(const JsonTextEdit& text, std::string_view name) {
  return text.text().find(name) != std::string::npos || text.text().find('\\') != std::string::npos;
}

TakenAlong taken(const Path& path) {
  TakenAlong out;
  out.list = path[0].key;
  size_t used = 1;
  if (path.size() > 1 && !path[1].index && out.list != "lesson") out.name = path[used++].key;
  out.rest = text_of(std::span(path).subspan(used));
  return out;
}

bool is_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Replaces `name` by `to` wherever `before` precedes it and no letter follows.
std::string with_name(std::string text, const std::string& before, const std::string& name,
                      const std::string& to) {
  const std::string head = before + name;
  for (size_t at = 0; (at = text.find(head, at)) != std::string::npos;) {
    const size_t end = at + head.size();
    const bool whole =
        (end == text.size() || !is_letter(text[end])) &&
        (at == 0 || !(is_letter(text[at - 1]) || text[at - 1] == '.') || before.front() == '.');
    if (whole) text.replace(at + before.size(), name.size(), to);
    at += before.size() + (whole ? to.size() : name.size());
  }
  return text;
}

/// The expression with `to` in the place of the parameter `name`, which stands alone: no quantity
/// ("bodies.name.mass"), no function, no part of a longer name.
std::string with_parameter_name(std::string text, const std::string& name, const std::string& to) {
  for (size_t at = 0; (at = text.find(name, at)) != std::string::npos;) {
    const size_t end = at + name.size();
    const bool begins = at == 0 || !(is_letter(text[at - 1]) || text[at - 1] == '.');
    const bool ends =
        end == text.size() || !(is_letter(text[end]) || text[end] == '(' || text[end] == '.');
    if (begins && ends) text.replace(at, name.size(), to);
    at += begins && ends ? to.size() : name.size();
  }
  return text;
}

/// Parameters are named in values ("$gap", "= 2 * gap"), in what a scene asserts, and in what a
/// lesson chooses ("parameters.gap=3").
std::string with_parameter_renamed(std::string_view key, const std::string& text,
                                   const std::string& name, const std::string& to) {
  if (key == "choose") return with_name(text, "parameters.", name, to);
  const bool expression =
      among(expression_keys, key) || text.starts_with('$') || text.starts_with('=');
  return expression ? with_parameter_name(text, name, to) : text;
}

void rename_parameter(JsonTextEdit& text, const JsonNode& node, std::string_view key,
                      const Path& path, const std::string& name, const std::string& to) {
  if (node.is(JsonNode::Kind::string)) {
    const std::string now = with_parameter_renamed(key, node.string, name, to);
    if (now != node.string) text.set(path, nlohmann::json(now).dump());
    return;
  }
  for (size_t i = 0; i < node.items.size(); ++i) {
    const bool object = node.is(JsonNode::Kind::object);
    rename_parameter(text, node.items[i], object ? std::string_view(node.keys[i]) : key,
                     object ? path / node.keys[i] : at_index(path, i), name, to);
  }
}

/// What a robot is made of keeps the names that others know it by.
void keep_prefix(JsonTextEdit& text, const Path& robot) {
  const auto said = text.value(robot);
  if (!said || text.value(robot / "prefix")) return;
  if (!said->starts_with('{')) text.set(robot, fmt::format("{{ \"file\": {} }}", *said));
  text.set(robot / "prefix", fmt::format("\"{}_\"", robot.back().key));
}

/// An expression over quantities, or a name with the number of a copy behind it.
std::string renamed_text(const Gone& gone, std::string_view key, const std::string& text,
                         const std::string& to) {
  if (!among(expression_keys, key)) return to + text.substr(gone.name.size());
  std::string out = with_name(text, gone.list + ".", gone.name, to);
  if (gone.list == "forces" || gone.list == "particles")
    out = with_name(out, "ledger.forces.", gone.name, to);
  return gone.list == "bodies" ? with_name(out, ".holds.", gone.name, to) : out;
}

}  // namespace

Result<std::string> renamed(const std::string& scene, const std::string& list,
                            const std::string& name, const std::string& to) {
  const auto refused = [](std::string why) {
    return Error{ErrorCode::invalid_argument, std::move(why), {}, {}};
  };
  if (to.empty() || !std::ranges::all_of(to, is_letter))
    return refused("a name is of letters, digits and _ alone");
  JsonTextEdit text(scene);
  if (!text.value(Path{} / list / name))
    return refused(fmt::format("{} is not among the {} of the file", name, list));
  if (text.value(Path{} / list / to))
    return refused(fmt::format("there is a {} already among the {}", to, list));
  FaultList faults;
  const auto tree = parse_json(scene, "", faults);
  if (!tree) return refused("the file is no scene");
  const Gone gone{list, name};
  Search(gone).all_in(*tree, [&](const Path& path, std::string_view key, const std::string& said) {
    text.set(path, nlohmann::json(renamed_text(gone, key, said, to)).dump());
  });
  if (list == "parameters") rename_parameter(text, *tree, "", {}, name, to);
  if (list == "robots") keep_prefix(text, Path{} / list / name);
  text.rename(Path{} / list / name, to);
  return text.text();
}

std::string TakenAlong::words() const {
  constexpr std::pair<std::string_view, std::string_view> kinds[] = {
      {"joints", "joint"},     {"forces", "force"}, {"particles", "particle system"},
      {"emitters", "emitter"}, {"sinks", "sink"},   {"sensors", "sensor"},
      {"cameras", "camera"},   {"bodies", "body"},  {"materials", "material"}};
  std::string kind = list;
  for (const auto& [of_list, one] : kinds)
    if (of_list == list) kind = one;
  if (list == "assertions") return "an assertion";
  const std::string what = name.empty() ? kind : kind + " " + name;
  return rest.empty() ? what : rest + " of " + what;
}

std::vector<TakenAlong> drop_dependents(JsonTextEdit& text, std::string_view list,
                                        const std::string& name) {
  std::vector<TakenAlong> out;
  if (!may_name(text, name)) return out;
  std::deque<Gone> gone{{std::string(list), name}};
  while (!gone.empty()) {
    FaultList faults;
    const auto tree = parse_json(text.text(), "", faults);
    if (!tree) return out;
    const auto found = Search(gone.front()).in(*tree);
    if (!found) {
      gone.pop_front();
      continue;
    }
    const Path path = to_be_removed(*tree, *found);
    const bool of_sink = path.size() == 3 && takes_bodies_too(*tree, path);
    if (!text.remove(path)) return out;
    if (of_sink) text.set({path[0], path[1], {"takes", {}}}, "\"bodies\"");
    out.push_back(taken(path));
    if (const TakenAlong& last = out.back(); last.rest.empty() && !last.name.empty())
      gone.push_back({last.list, last.name});
  }
  return out;
}

std::string held_by_count(const JsonTextEdit& text, const std::string& body) {
  constexpr double most = 1e5;  // a larger number is rejected when a scene is read
  const std::string copies = body.substr(0, body.find('[') + 1);
  FaultList faults;
  const auto tree = may_name(text, copies) ? parse_json(text.text(), "", faults) : std::nullopt;
  if (!tree) return {};
  const auto names = [&](const std::string& name, const JsonNode& count) {
    // The number of copies is not known here, so each index counts as a copy.
    if (count.is(JsonNode::Kind::string)) return name.starts_with(copies);
    for (int n = 0; n < int(count.number); ++n)
      if (const auto one = counted_name(name, n); one && *one == body) return true;
    return false;
  };
  for (const char* list : {"joints", "sensors"}) {
    const JsonNode* all = tree->find(list);
    for (size_t i = 0; all && i < all->keys.size(); ++i) {
      const JsonNode* count = all->items[i].find("count");
      const bool several =
          count && (count->is(JsonNode::Kind::string) || (count->is_number() && count->number > 1));
      if (!several || count->number > most) continue;
      for (const char* key : {"a", "b", "body"})
        if (const JsonNode* name = all->items[i].find(key);
            name && !name->string.empty() && names(name->string, *count))
          return fmt::format("{}.{}", list, all->keys[i]);
    }
  }
  return {};
}

}  // namespace tumble
