#pragma once
#include "engine/scene/visitors/structure.hpp"

#include <functional>
#include <string>

namespace tumble {

/// Receives the faults found: the full path and a message.
using FaultSink = std::function<void(std::string path, std::string message)>;

/// Checks the ranges of all values of a description at a path, and calls each struct's own check().
void validate_object(const StructRef& value, const std::string& path, const FaultSink& sink);

}  // namespace tumble
