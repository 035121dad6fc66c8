#pragma once
#include "engine/core/result.hpp"
#include "engine/scene/outline/members.hpp"
#include "engine/scene/saving/json_text_edit.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Where something stands in a scene, as faults and --set name it: "bodies.ball.shapes[0].radius".
/// The file may write it shorter: one object alone for a list of one, a bare value for an object
/// that has a shorthand ("steel" for {"like": "steel"}).
using ScenePath = JsonTextEdit::Path;

std::string text_of(const ScenePath& path);
inline ScenePath outer_path(const ScenePath& path) {
  return {path.begin(), path.end() - (path.empty() ? 0 : 1)};
}
/// A value on one line, as scenes are written.
std::string one_line(const JsonNode& node);

/// A value of a scene's file, or one that could stand there.
struct Place {
  Member what;
  const JsonNode* node = nullptr;  ///< null: it is not there
  ScenePath in_text;               ///< where the text has it, or would have it
  /// It has a name of its own, which can be changed.
  bool named = false;
  /// It is one of a list or of several values.
  bool numbered = false;
  /// What is written in short on the way, and what has to stand around it before something can be
  /// put here.
  struct WrittenOut {
    ScenePath in_text;
    std::string before, after;
  };
  std::optional<WrittenOut> first;
};

/// Nothing where the declarations know no such place.
std::optional<Place> place_of(const JsonNode& scene, const ScenePath& path);

/// What something with parts says of itself in few words: "radius", "m", "0.5".
struct ToldValue {
  std::string key, unit, value;
  bool choice = false;  ///< it is a word of the declarations, or several
};
/// One key of an object, or one item of a list, a map or several values.
struct OutlineKey {
  Member what;
  std::string text;     ///< the value as the file has it, on one line; "": it is not there
  std::string summary;  ///< of what has parts: "3 items", "sphere"; "": its kind has no word
  /// Of an object: the plain values that set it apart from the others in its list, or all of them
  /// where none does.
  std::vector<ToldValue> told;
  bool present() const { return !text.empty(); }
};
/// All that can be read and changed about one place of a scene.
struct Outline {
  ScenePath path;
  Member what;
  bool there = false, named = false, numbered = false;
  std::vector<OutlineKey> keys;  ///< in the order of the declarations, those that are not there too
  /// Names that a text of `refers_to` can be, by list.
  std::vector<std::string> names_of(std::string_view list) const;
  std::vector<std::pair<std::string, std::vector<std::string>>> names;
  /// What this, or what is added to it, may be called, where another file has the names.
  std::vector<std::string> own_names;
};
/// Of the nearest place around `path` that is there and has parts.
Outline outline_of(const JsonNode& scene, ScenePath path);

/// The names that something may be called by who refers to a list: copies as "brick[0]", materials
/// that come with Tumble included.
std::vector<std::string> names_in(const JsonNode& scene, std::string_view list);

}  // namespace tumble
