#pragma once
#include <limits>
#include <string_view>

namespace tumble {

/// The one declaration of a user-settable value. A definition struct lists its members once:
///
///     template <class Visitor, class Self>            // Self is BodyDef or const BodyDef
///     static void parameters(Visitor& v, Self& d) {
///       v.field(d.mass, {.name = "mass", .unit = "kg", .min = 0, .doc = "total mass"});
///       ...
///     }
///
/// and every use (scene reader and writer, JSON schema, panels, --set, documentation) is a visitor
/// over that list.
struct Parameter {
  std::string_view name;       ///< key in the scene file and last part of its path
  std::string_view unit = "";  ///< SI unit as printed, "" for pure numbers
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool exclusive_min = false;  ///< the value must be > min, not >= min
  bool required = false;       ///< the scene file must give it
  std::string_view doc = "";   ///< one line for people
};

}  // namespace tumble
