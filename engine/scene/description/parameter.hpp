#pragma once
#include "engine/scene/description/values.hpp"

namespace tumble {

/// A number that a scene declares for use in its values ("$name", "= 2 * name") and for --set. In a
/// file a bare number stands for {"value": number}.
struct ParameterDescription {
  double value = 0;
  std::optional<double> min, max;
  std::string doc;

  static constexpr std::string_view schema_name = "parameter";
  static constexpr std::string_view shorthand_key = "value";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.value,
            {.name = "value", .required = true, .doc = "unless --set parameters.NAME=..."});
    v.field(d.min, {.name = "min", .doc = "least value that makes sense"});
    v.field(d.max, {.name = "max", .doc = "greatest value that makes sense"});
    v.field(d.doc, {.name = "doc", .doc = "what it does"});
  }
  static void check(const ParameterDescription& d, Complaints& complaints) {
    if ((d.min && d.value < *d.min) || (d.max && d.value > *d.max))
      complaints.add("value", "outside its own min and max");
  }
};

}  // namespace tumble
