#pragma once
#include <cstdint>

namespace tumble {

/// Whether links that no joint of a robot file attaches to the world are fixed or move freely.
enum class RobotBase : uint8_t { file, fixed, floating };

/// Which motors a robot has.
enum class RobotMotors : uint8_t {
  hold,  ///< joints without a motor are held at their start
  file,  ///< only those of the file
};

}  // namespace tumble
