#include "engine/scene/workloads/peak_memory.hpp"

#include <fstream>
#include <sstream>
#include <string>

namespace tumble {

void restart_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("VmHWM:")) continue;
    std::istringstream number(line.substr(6));
    double kilobytes = 0;
    number >> kilobytes;
    return kilobytes * 1024 / 1e6;
  }
  return 0;
}

}  // namespace tumble
