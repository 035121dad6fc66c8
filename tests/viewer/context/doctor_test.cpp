// The doctor. Reference: the same backends made directly, and a machine whose drivers are gone.
#include "viewer/context/doctor.hpp"

#include "tests/viewer/context/child.hpp"
#include "viewer/context/backends.hpp"

#include <algorithm>
#include <cstdlib>

#include <doctest/doctest.h>

using namespace tumble;
using tumble::test::in_child;

namespace {

const DoctorEntry* find(const std::vector<DoctorEntry>& entries, const char* name) {
  const auto it = std::find_if(entries.begin(), entries.end(),
                               [&](const DoctorEntry& e) { return e.name == name; });
  return it == entries.end() ? nullptr : &*it;
}

}  // namespace

TEST_CASE("the doctor tries every way to draw, and each answer has what a person needs") {
  const auto entries = run_doctor();
  const std::string devices = in_child([]() -> std::string {
    const auto found = egl_devices();
    return found ? std::to_string(found->size()) : "none";
  });
  CHECK(std::to_string(entries.size() - 3) == devices);
  for (const char* name : {"window", "egl:0", "surfaceless", "osmesa"}) {
    CAPTURE(name);
    const DoctorEntry* e = find(entries, name);
    REQUIRE(e);
    if (e->ok) {
      CHECK_FALSE(e->renderer.empty());
      CHECK_FALSE(e->version.empty());
    } else {
      CHECK_FALSE(e->cause.empty());
      CHECK_FALSE(e->cure.empty());
    }
  }
  CHECK(find(entries, "osmesa")->ok);
  CHECK(doctor_text(entries).find("osmesa") != std::string::npos);
}

TEST_CASE("the doctor survives missing drivers and names the cure") {
  const std::string report = in_child([]() -> std::string {
    setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
    unsetenv("DISPLAY");
    return doctor_text(run_doctor());
  });
  CAPTURE(report);
  CHECK(report.find("failed  window") != std::string::npos);
  CHECK(report.find("failed  egl") != std::string::npos);
  CHECK(report.find("failed  surfaceless") != std::string::npos);
  CHECK(report.find("unset __EGL_VENDOR_LIBRARY_DIRS") != std::string::npos);
  CHECK(report.find("ok      osmesa") != std::string::npos);
}
