#pragma once
#include "engine/scene/visitors/structure.hpp"

#include <functional>
#include <string>

namespace tumble {

/// Where a validator puts what it finds: a full path and a message.
using FaultSink = std::function<void(std::string path, std::string message)>;

/// Checks the ranges of a description that stands at a path, and calls each struct's own check().
void validate_object(const StructRef& value, const std::string& path, const FaultSink& sink);

}  // namespace tumble
