#pragma once
#include "engine/scene/visitors/read_values.hpp"
#include "engine/scene/visitors/structure.hpp"

namespace tumble {

/// Greatest number of names in one object; look-up is linear.
constexpr size_t max_names = 20000;

/// Fills a struct from a JSON object. Checks types, required and unknown keys; the validator checks
/// ranges.
void read_object(ReadContext& c, const JsonNode& node, const std::string& path,
                 const StructRef& out);

}  // namespace tumble
