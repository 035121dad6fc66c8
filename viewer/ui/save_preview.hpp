#pragma once
#include <string>
#include <vector>

namespace tumble {

/// Preview of what saving the scene would write.
struct SavePreview {
  std::string file;                   ///< the file to be written
  std::vector<std::string> lines;     ///< "- 12: old", "+ 12: new"; empty: no changes
  std::vector<std::string> left_out;  ///< changes that a scene file cannot represent
  std::string warning;                ///< "": none
  std::string fault;                  ///< why it cannot be saved; "": it can
  bool only_there = false;  ///< the fault depends on the folder; saving elsewhere may work
};

}  // namespace tumble
