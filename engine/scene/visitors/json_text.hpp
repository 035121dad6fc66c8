#pragma once
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace tumble {

/// Indented JSON, with short arrays and objects on one line.
std::string pretty(const nlohmann::ordered_json& value);

}  // namespace tumble
