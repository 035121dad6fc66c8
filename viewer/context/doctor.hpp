#pragma once
#include <string>
#include <vector>

namespace tumble {

/// Result of testing one way to draw.
struct DoctorEntry {
  std::string name;  ///< "window", "egl:0", "surfaceless", "osmesa"
  bool ok = false;   ///< a context was made, and a triangle was drawn and read back correctly
  std::string detail;
  std::string renderer;
  std::string version;
  bool software = false;
  std::string cause;  ///< if not ok: what failed
  std::string cure;   ///< if not ok: what to do
};

/// Tests the window, every EGL device, surfaceless and OSMesa, each in a child process, so that a
/// driver that crashes is reported like any other fault. Must be called before threads are started.
std::vector<DoctorEntry> run_doctor();

/// The report as text, line by line.
std::string doctor_text(const std::vector<DoctorEntry>& entries);

}  // namespace tumble
