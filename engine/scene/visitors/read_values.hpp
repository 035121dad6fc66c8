#pragma once
#include "engine/scene/description.hpp"
#include "engine/scene/json_tree.hpp"

#include <string>
#include <vector>

namespace tumble {

/// What reading a file shares: faults, and the parameters read so far.
struct ReadContext {
  std::string file;
  FaultList& faults;
  std::vector<std::pair<std::string, double>> parameters;

  void fault(const JsonNode& node, std::string path, std::string message);
};

// Leaves of a scene file. Each leaves `out` alone after a fault. Numbers may be given as "$name" or
// "= expression" over the scene's parameters.
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, double& out);
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, int& out);
/// Besides what a number may be: an expression that has `t` in it, or an array of [time, value].
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, Varying& out);
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, uint64_t& out);
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, bool& out);
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, std::string& out);
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, Vec3& out);
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, Quat& out);
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, Colour& out);
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, TickRate& out);
void read_value(ReadContext& c, const JsonNode& node, const std::string& path,
                std::array<int, 3>& out);

/// The position of a name in a list of names, with a fault when it is not there.
std::optional<size_t> read_name(ReadContext& c, const JsonNode& node, const std::string& path,
                                std::string_view what, const std::vector<std::string>& names);

template <class E>
requires std::is_enum_v<E>
void read_value(ReadContext& c, const JsonNode& node, const std::string& path, E& out) {
  std::vector<std::string> names;
  for (const auto& [name, value] : EnumNames<E>::values) names.emplace_back(name);
  if (const auto i = read_name(c, node, path, "value", names))
    out = EnumNames<E>::values[*i].second;
}

template <class T>
void read_value(ReadContext& c, const JsonNode& node, const std::string& path,
                std::vector<T>& out) {
  if (!node.is(JsonNode::Kind::array))
    return c.fault(node, path, "must be an array, got " + brief(node));
  out.clear();
  out.reserve(node.items.size());
  for (size_t i = 0; i < node.items.size(); ++i)
    read_value(c, node.items[i], path + "[" + std::to_string(i) + "]", out.emplace_back());
}

template <class T>
void read_value(ReadContext& c, const JsonNode& node, const std::string& path,
                std::optional<T>& out) {
  read_value(c, node, path, out.emplace());
}

}  // namespace tumble
