#pragma once
#include <string_view>

namespace tumble {

/// Keys of a scene file whose text, or texts in an array, are names of things in one of its lists.
/// One table for what is offered as a choice, what is renamed, and what goes along with something
/// removed. Of `a` and `b` only texts are meant: those of a spring are objects.
struct NamingKey {
  std::string_view key, list;
};
constexpr NamingKey naming_keys[] = {{"body", "bodies"},        {"a", "bodies"},
                                     {"b", "bodies"},           {"bodies", "bodies"},
                                     {"carrier", "bodies"},     {"follow", "bodies"},
                                     {"joint", "joints"},       {"particles", "particles"},
                                     {"between", "particles"},  {"emitter", "emitters"},
                                     {"camera", "cameras"},     {"mesh", "meshes"},
                                     {"material", "materials"}, {"like", "materials"}};

/// The list that a key names a thing of; "": it names none.
constexpr std::string_view list_named_by(std::string_view key) {
  for (const NamingKey& naming : naming_keys)
    if (naming.key == key) return naming.list;
  return {};
}

}  // namespace tumble
