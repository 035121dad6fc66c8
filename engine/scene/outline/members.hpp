#pragma once
#include "engine/scene/json_tree.hpp"
#include "engine/scene/visitors/structure.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

enum class MemberKind : uint8_t {
  number,
  whole,   ///< a number without a fraction
  rate,    ///< ticks a second: a whole number or "n/d"
  truth,   ///< true or false
  text,    ///< or the name of something else in the scene
  choice,  ///< one of the names that the declaration knows
  vector,  ///< so many numbers
  colour,
  values,  ///< any number of them in an array, each without keys of its own
  object,
  list,  ///< objects in an array; one alone may stand without it
  map    ///< objects by names of their own
};

/// What the declarations of parameters say about one key of an object in a scene file.
struct Member {
  std::string name, unit, doc;
  double min = 0, max = 0;
  bool exclusive_min = false;
  bool required = false;
  MemberKind kind = MemberKind::text;
  size_t size = 0;                 ///< of a vector
  bool varies = false;             ///< a number that may follow an expression in t, or a table
  bool selects = false;            ///< its value says which further keys the object has
  std::vector<std::string> names;  ///< that a choice offers
  /// Of what the text is a name: "bodies", "materials"; "" where it names nothing.
  std::string refers_to;
  std::shared_ptr<const Member> item;  ///< what each of several values is; null: it is not several
  const StructType* type = nullptr;    ///< of an object, or of each in a list or map
  std::string fallback;                ///< what holds where the key is absent, as JSON; "": nothing

  /// The range as an instruction, "" where the value is no number.
  std::string range() const;
  bool is_number() const {
    return kind == MemberKind::number || kind == MemberKind::whole || kind == MemberKind::rate;
  }
  /// Has keys, names or places below it.
  bool has_parts() const {
    return kind == MemberKind::object || kind == MemberKind::list || kind == MemberKind::map ||
           kind == MemberKind::values;
  }
};

/// All keys that an object of this type may have, in the order of the declarations. Which they are
/// may depend on what it says already (`"type": "sphere"`); null: it is not there.
std::vector<Member> members_of(const StructType& type, const JsonNode* object);

/// What the scene itself is.
Member scene_member();

}  // namespace tumble
