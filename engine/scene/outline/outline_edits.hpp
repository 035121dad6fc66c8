#pragma once
#include "engine/scene/outline/outline.hpp"
#include "engine/scene/saving/dependents.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

// Changes of a scene's text, one value at a time. Everything else keeps its bytes. The result need
// not be a scene: who changes one thing after the other may pass through what the reader refuses.

/// The text with this JSON value in the place of what stands there, or added where nothing does.
/// Where the value says which further keys there are (`type` of a shape), keys that are unknown
/// then are left out, and those that it needs are added.
Result<std::string> with_value(const std::string& text, const ScenePath& path,
                               std::string_view value);

/// The text with one more key, name or item, of a value that means something: what the declaration
/// has by default, a name that is there, all keys that it needs. Of a switch the opposite of the
/// default, without which adding it would do nothing.
Result<std::string> with_added(const std::string& text, const ScenePath& path);

/// The text without it. What cannot do without something that has a name goes along, and is told.
Result<std::string> without(const std::string& text, const ScenePath& path,
                            std::vector<TakenAlong>& along);

/// The text with an item of a list, or one of several values, so many places farther down (less
/// than 0: up). Comments on lines of their own stay.
Result<std::string> with_moved(const std::string& text, const ScenePath& path, int places);

/// The text in which the number at `path` is one that the scene declares: "parameters" gets it by a
/// free name after the key, and "$name" stands in its place. Gives the name, too.
struct Declared {
  std::string text, name;
};
Result<Declared> with_parameter(const std::string& text, const ScenePath& path);

/// What a person types for a value of this kind, as JSON: numbers, "= 2 * n", "$n", tables.
/// Error: it can be none.
Result<std::string> typed_value(const Member& what, std::string_view typed);
/// The same the other way: how a JSON value is shown to be typed over.
std::string shown_value(std::string_view json);

/// A name after `stem` that nothing in the list has yet.
std::string free_name(const JsonNode& scene, std::string_view list, std::string_view stem);

}  // namespace tumble
