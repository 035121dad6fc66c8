#pragma once
#include "engine/core/error.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// A fault in a scene: what is wrong, and exactly where.
struct Fault {
  std::string file;  ///< as the caller named it; empty for scenes made by code
  int line = 0;      ///< 1-based; 0 when it does not come from a line (an override, a whole file)
  std::string path;  ///< "bodies.ball.mass"; empty for the whole file
  std::string message;

  /// "file:line: path: message"
  std::string text() const;
};

/// Collects faults; only the first at each path is kept.
class FaultList {
 public:
  void add(Fault fault);
  /// Whether there is a fault at this path, above it or below it.
  bool covers(std::string_view path) const;
  bool empty() const { return faults_.empty(); }
  /// In the order of the file.
  std::vector<Fault> sorted() const;

 private:
  std::vector<Fault> faults_;
};

/// All faults as one error of code `parse`: the text of each on its own line.
Error to_error(const std::vector<Fault>& faults);

}  // namespace tumble
