#include "engine/scene/description/joint.hpp"

#include "engine/core/text.hpp"

#include <fmt/format.h>

namespace tumble {
std::string names_of_coordinates(const JointKindEntry& kind) {
  if (kind.coordinates.empty())
    return fmt::format("a {} joint leaves nothing to act on", kind.name);
  std::string out;
  for (const JointCoordinate& c : kind.coordinates)
    out += (out.empty() ? "" : ", ") + std::string(c.name);
  return fmt::format("the coordinates of a {} joint are: {}", kind.name, out);
}

namespace {

/// Checks that angles are given by keys in degrees, and lengths by keys without a suffix.
void check_units(const DriveDescription& d, bool angle, const std::string& path,
                 Complaints& complaints) {
  const auto refuse = [&](bool given, const char* key) {
    if (given)
      complaints.add(path + key, angle ? "this coordinate is an angle: write the key with _deg"
                                       : "this coordinate is a length: write the key without _deg");
  };
  if (d.limits) {
    refuse(angle && d.limits->lower, "limits.lower");
    refuse(angle && d.limits->upper, "limits.upper");
    refuse(!angle && d.limits->lower_deg, "limits.lower_deg");
    refuse(!angle && d.limits->upper_deg, "limits.upper_deg");
  }
  if (d.motor) {
    refuse(angle && d.motor->position, "motor.position");
    refuse(!angle && d.motor->position_deg, "motor.position_deg");
  }
  if (d.spring) {
    refuse(angle && d.spring->rest, "spring.rest");
    refuse(!angle && d.spring->rest_deg, "spring.rest_deg");
  }
  if (d.couple) {
    refuse(angle && d.couple->offset, "couple.offset");
    refuse(!angle && d.couple->offset_deg, "couple.offset_deg");
  }
}

}  // namespace

void JointDescription::check_drives(const JointDescription& d, Complaints& complaints) {
  const JointKindEntry& kind = entry_of(d.kind);
  if (!d.drive.empty()) {
    if (kind.coordinates.size() == 1)
      check_units(d.drive, kind.coordinates[0].angle, "", complaints);
    else
      complaints.add(
          "", fmt::format("limits, motor, spring, friction, armature and couple need the name of "
                          "a coordinate about them; {}",
                          names_of_coordinates(kind)));
  }
  for_drives(d, [&](const std::string& name, const std::optional<DriveDescription>& drive) {
    if (!drive) return;
    const size_t k = coordinate_named(d.kind, name);
    if (k == kind.coordinates.size()) return complaints.add(name, names_of_coordinates(kind));
    if (kind.coordinates.size() == 1 && !d.drive.empty())
      complaints.add(name, "what acts along it stands in the joint itself already");
    check_units(*drive, kind.coordinates[k].angle, name + ".", complaints);
  });
}

}  // namespace tumble
