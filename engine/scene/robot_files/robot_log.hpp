#pragma once
#include "engine/scene/fault.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// A line of a robot file, or of one that it includes.
struct RobotPlace {
  std::shared_ptr<const std::string> file;
  int line = 0;
};

/// Faults of a robot file, and requests of it that are not supported.
class RobotLog {
 public:
  void fault(const RobotPlace& at, std::string message);
  /// Reports a request that is not, or not exactly, fulfilled. Equal messages of several lines
  /// become one warning that lists the lines.
  void warn(const RobotPlace& at, const std::string& message);

  const std::vector<Fault>& faults() const { return faults_; }
  bool ok() const { return faults_.empty(); }
  /// "file:12: message (also in lines 15, 20)", in the order of their first lines.
  std::vector<std::string> warnings() const;

 private:
  struct Warning {
    std::string file, message;
    std::vector<int> lines;
  };
  std::vector<Fault> faults_;
  std::vector<Warning> warnings_;
};

}  // namespace tumble
