#pragma once
#include "engine/core/result.hpp"

#include <string>

namespace tumble::test {

/// The text of a result's error, or that there is none: for messages of assertions, which are put
/// together where all successes are listed, too.
template <class T>
std::string why_not(const Result<T>& result) {
  return result.ok() ? "ok" : result.error().text();
}

}  // namespace tumble::test
