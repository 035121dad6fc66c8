#include "viewer/ui/assertion_view.hpp"

#include <fmt/format.h>

namespace tumble {

std::string when_text(const AssertionView& a) {
  if (a.always) return a.at ? fmt::format("always from {:g} s on", *a.at) : "always";
  return a.at ? fmt::format("at {:g} s", *a.at) : "at the end";
}

}  // namespace tumble
