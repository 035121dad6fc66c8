#pragma once
#include <string>
#include <vector>

namespace tumble {

/// The lines in which two texts differ: "- 12: old", "+ 12: new".
std::vector<std::string> changed_lines(const std::string& before, const std::string& after);

}  // namespace tumble
