#pragma once
#include <string>
#include <vector>

namespace tumble {

/// What saving the scene would write, before it does.
struct SavePreview {
  std::string file;                   ///< where it would go
  std::vector<std::string> lines;     ///< "- 12: old", "+ 12: new"; none: nothing was changed
  std::vector<std::string> left_out;  ///< what a file cannot say
  std::string warning;                ///< "": none
  std::string fault;                  ///< why it cannot be saved, "" when it can
  bool only_there = false;            ///< the fault may not hold in another folder
};

}  // namespace tumble
