#pragma once
#include "engine/collision/shape.hpp"

namespace tumble {

/// A required length of a shape, > 0 and at most a million metres.
constexpr Parameter length_parameter(std::string_view name, std::string_view doc) {
  return {.name = name,
          .unit = "m",
          .min = 0,
          .max = 1e6,
          .exclusive_min = true,
          .required = true,
          .doc = doc};
}

}  // namespace tumble
