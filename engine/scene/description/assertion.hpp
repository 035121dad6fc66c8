#pragma once
#include "engine/scene/description/values.hpp"

#include <optional>
#include <string>

namespace tumble {

/// A condition that a scene claims about itself, checked while it runs.
struct AssertionDescription {
  std::string holds;  ///< a condition over what `tumble simulate --assert` knows, and parameters
  std::string title;
  std::optional<double> at;  ///< [s]; none: at the end of a run, or with `always` from the start
  bool always = false;

  static constexpr std::string_view schema_name = "assertion";
  static constexpr std::string_view shorthand_key = "holds";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.holds,
            {.name = "holds",
             .required = true,
             .doc = "a condition over quantities of --assert and parameters of the scene"});
    v.field(d.title, {.name = "title", .doc = "the same in words"});
    v.field(d.at, {.name = "at",
                   .unit = "s",
                   .min = 0,
                   .max = 1e6,
                   .doc = "the moment at which it holds; at the end of a run unless given"});
    v.field(d.always,
            {.name = "always",
             .doc = "it holds after every tick, from the moment `at` on if that is given"});
  }
  static void check(const AssertionDescription& d, Complaints& complaints);
};

}  // namespace tumble
