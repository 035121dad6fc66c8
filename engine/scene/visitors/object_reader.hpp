#pragma once
#include "engine/scene/visitors/read_values.hpp"
#include "engine/scene/visitors/structure.hpp"

namespace tumble {

/// Names in one object; looking them up is linear.
constexpr size_t max_names = 20000;

/// Fills a struct from a JSON object: types, required and unknown keys. Ranges are the validator's.
void read_object(ReadContext& c, const JsonNode& node, const std::string& path,
                 const StructRef& out);

}  // namespace tumble
