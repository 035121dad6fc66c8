#pragma once
#include "engine/core/parameters.hpp"
#include "engine/math/types.hpp"
#include "engine/math/varying.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tumble {

/// Objects that the file names by their keys, in the order of the file.
template <class T>
struct NamedList {
  struct Item {
    std::string name;
    T value;
  };
  std::vector<Item> items;

  const T* find(std::string_view name) const {
    for (const Item& i : items)
      if (i.name == name) return &i.value;
    return nullptr;
  }
  T& add(std::string name, T value = {}) {
    return items.emplace_back(Item{std::move(name), std::move(value)}).value;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const Item& i : items) out.push_back(i.name);
    return out;
  }
  bool empty() const { return items.empty(); }
  size_t size() const { return items.size(); }
};

/// The name of an alternative of a variant in files: its `type_name`, a constant or a function.
template <class T>
std::string_view type_name_of() {
  if constexpr (requires { T::type_name(); })
    return T::type_name();
  else
    return T::type_name;
}

/// A colour in sRGB, components in 0..1, as in files.
struct Colour {
  double r = 0.8, g = 0.8, b = 0.8;
  /// Linear RGB, as used for shading.
  Vec3f linear() const;
  static Colour from_linear(const Vec3f& rgb);
};
/// Parses "#rrggbb", "#rgb" or a named colour.
std::optional<Colour> colour_from_text(std::string_view text);
/// Names of the built-in colours.
const std::vector<std::pair<std::string_view, Colour>>& named_colours();
std::vector<std::string> palette_names();

/// A number over time, times a unit; null if it is constant.
std::shared_ptr<const TimeCourse> course_of(const Varying& number, double unit = 1);

/// Names of an enumeration's values in scene files; specialise `values`.
template <class E>
struct EnumNames;

template <class E>
std::string_view enum_name(E value) {
  for (const auto& [name, v] : EnumNames<E>::values)
    if (v == value) return name;
  return {};
}

/// Receives the faults found by a struct's own check: the member concerned and the message.
class Complaints {
 public:
  virtual ~Complaints() = default;
  /// `member` is relative to the struct: "angle_deg", "count[1]"; empty for the struct itself.
  virtual void add(std::string_view member, std::string message) = 0;
};

}  // namespace tumble
