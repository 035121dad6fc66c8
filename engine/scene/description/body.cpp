#include "engine/scene/description/body.hpp"

#include "engine/math/expression.hpp"

namespace tumble {
namespace {

void check_expressions(const std::vector<std::string>& texts, std::string_view member,
                       Complaints& complaints) {
  if (!texts.empty() && texts.size() != 3) {
    complaints.add(member, "needs 3 expressions, got " + std::to_string(texts.size()));
    return;
  }
  for (size_t i = 0; i < texts.size(); ++i) {
    const auto parsed = Expression::parse(texts[i]);
    if (!parsed)
      complaints.add(std::string(member) + "[" + std::to_string(i) + "]", parsed.error().message);
  }
}

}  // namespace

void FormulaRepetition::check(const FormulaRepetition& d, Complaints& complaints) {
  if (d.position.empty() && d.euler_deg.empty())
    complaints.add("", "a formula needs position, euler_deg or both");
  check_expressions(d.position, "position", complaints);
  check_expressions(d.euler_deg, "euler_deg", complaints);
}

void BodyDescription::check(const BodyDescription& d, Complaints& complaints) {
  if (d.shape && !d.shapes.empty()) complaints.add("shapes", "give shape or shapes, not both");
  const bool scenery = d.type != BodyType::dynamic && !d.drawn.empty();
  if (!d.shape && d.shapes.empty() && !(d.mass && d.inertia) && !scenery)
    complaints.add("", "a body needs a shape (or mass and inertia)");
  if (d.products && !d.inertia) complaints.add("products_of_inertia", "needs inertia");
  if (d.centre && !d.inertia) complaints.add("centre_of_mass", "needs inertia");
  if (d.mass && d.density) complaints.add("mass", "give mass or density, not both");
  if (d.angular_velocity_deg && !d.angular_velocity.isZero(0))
    complaints.add("angular_velocity_deg", "give angular_velocity or angular_velocity_deg");
  if (d.type == BodyType::fixed &&
      !(d.velocity.isZero(0) && d.angular_velocity.isZero(0) && !d.angular_velocity_deg))
    complaints.add("type", "a static body cannot have a velocity (type kinematic can)");
  if (d.course && d.type != BodyType::kinematic)
    complaints.add("course", "only a body of type kinematic has one");
  if (d.course &&
      !(d.velocity.isZero(0) && d.angular_velocity.isZero(0) && !d.angular_velocity_deg))
    complaints.add("course", "gives the velocity: leave velocity and angular_velocity out");
  if (d.repeat.empty() && !d.copies.empty())
    complaints.add("copies", "only a body with repeat has copies");
  for (const auto& copy : d.copies.items)
    if (copy.value.mass && copy.value.density)
      complaints.add("copies." + copy.name, "give mass or density, not both");
}

}  // namespace tumble
