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

/// What is wrong with a robot file, and what it asks for and does not get.
class RobotLog {
 public:
  void fault(const RobotPlace& at, std::string message);
  /// Something that is not followed or not as asked. The same of several lines becomes one warning
  /// that lists them.
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
