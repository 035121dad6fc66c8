#pragma once
#include "engine/scene/reader.hpp"
#include "tests/support/scale.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include <doctest/doctest.h>

namespace tumble {

inline std::string data_file(const std::string& name) {
  return std::string(TUMBLE_SOURCE_DIR) + "/tests/scene/data/" + name;
}

inline std::string file_text(const std::string& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

/// A scene around the given members.
inline std::string scene_with(const std::string& members) {
  return "{\"tumble_scene\": 1,\n" + members + "}\n";
}

/// All faults, a line each, for messages.
inline std::string all_text(const std::vector<Fault>& faults) {
  std::string out;
  for (const Fault& f : faults) out += f.text() + "\n";
  return out;
}

using test::scaled_count;

}  // namespace tumble
