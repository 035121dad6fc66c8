#pragma once
#include "engine/scene/fault.hpp"
#include "engine/scene/json_tree.hpp"
#include "engine/scene/visitors/structure.hpp"

#include <string>
#include <vector>

namespace tumble {

/// State shared while reading a file: faults, and the parameters read so far.
struct ReadContext {
  std::string file;
  FaultList& faults;
  std::vector<std::pair<std::string, double>> parameters;

  void fault(const JsonNode& node, std::string path, std::string message);
};

/// Reads a leaf; after a fault it is left unchanged. Numbers may be given as "$name" or "=
/// expression" over the scene's parameters.
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, const Leaf& out);

/// The index of a name in a list of names, with a fault if it is not there.
std::optional<size_t> read_name(ReadContext& c, const JsonNode& node, const std::string& path,
                                std::string_view what, const std::vector<std::string>& names);

}  // namespace tumble
