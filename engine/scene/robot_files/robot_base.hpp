#pragma once
#include <cstdint>

namespace tumble {

/// Whether what no joint of a robot file ties to the world stays there or moves freely.
enum class RobotBase : uint8_t { file, fixed, floating };

/// Which motors a robot has.
enum class RobotMotors : uint8_t {
  hold,  ///< joints without one are held where they start
  file,  ///< those of the file alone
};

}  // namespace tumble
