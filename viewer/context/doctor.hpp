#pragma once
#include <string>
#include <vector>

namespace tumble {

/// The health of one way to draw.
struct DoctorEntry {
  std::string name;  ///< "window", "egl:0", "surfaceless", "osmesa"
  bool ok = false;   ///< a context was made, a triangle drawn and read back right
  std::string detail;
  std::string renderer;
  std::string version;
  bool software = false;
  std::string cause;  ///< when not ok: what failed
  std::string cure;   ///< when not ok: what to do
};

/// Tries the window, every EGL device, surfaceless and OSMesa, each in a child process, so that a
/// driver that crashes is reported like any other fault. Call before threads are started.
std::vector<DoctorEntry> run_doctor();

/// The report as lines for people.
std::string doctor_text(const std::vector<DoctorEntry>& entries);

}  // namespace tumble
