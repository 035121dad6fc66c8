#include "engine/world/sensors/sensor.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

bool within(double x, double half) {
  return -half <= x && x < half;  // half-open: a point between two neighbours is in one
}

bool in_disc(const Vec3& x, double radius) {
  return x.x() * x.x() + x.z() * x.z() <= radius * radius;
}

/// The extents that a form uses, as bits for x, y and z.
int axes_of(SensorForm form) {
  switch (form) {
    case SensorForm::disc:
    case SensorForm::sphere:
      return 1;
    case SensorForm::cylinder:
      return 1 | 2;
    case SensorForm::rectangle:
      return 1 | 4;
    case SensorForm::box:
      break;
  }
  return 1 | 2 | 4;
}

}  // namespace

bool holds(const SensorShape& shape, const Vec3& x) {
  const Vec3& half = shape.half;
  switch (shape.form) {
    case SensorForm::disc:
      return in_disc(x, half.x());
    case SensorForm::rectangle:
      return within(x.x(), half.x()) && within(x.z(), half.z());
    case SensorForm::box:
      return within(x.x(), half.x()) && within(x.y(), half.y()) && within(x.z(), half.z());
    case SensorForm::sphere:
      return x.squaredNorm() <= half.x() * half.x();
    case SensorForm::cylinder:
      return in_disc(x, half.x()) && within(x.y(), half.y());
  }
  return false;
}

int passage(const SensorShape& shape, const Vec3& from, const Vec3& to) {
  const bool below = from.y() < 0;
  if (below == (to.y() < 0)) return 0;
  const double s = from.y() / (from.y() - to.y());
  if (!holds(shape, from + s * (to - from))) return 0;
  return below ? 1 : -1;
}

Status validate(const SensorDef& def) {
  const auto fault = [&def](std::string message) {
    return Error{ErrorCode::invalid_argument, std::move(message), "sensor '" + def.name + "'", {}};
  };
  if (def.kind == SensorKind::contact) {
    if (def.a.is_null()) return fault("a contact sensor needs a body");
    if (def.a == def.b) return fault("a and b are the same body");
    return {};
  }
  if (def.kind == SensorKind::radial) {
    if (!(def.range > 0 && std::isfinite(def.range)))
      return fault(fmt::format("range must be > 0, got {} m", def.range));
    if (def.shells < 1 || def.shells > SensorDef::most_shells)
      return fault(
          fmt::format("shells must be 1 to {}, got {}", SensorDef::most_shells, def.shells));
    if (def.only_systems.empty()) return fault("a radial distribution is of particle systems");
    for (auto it = def.only_systems.begin(); it != def.only_systems.end(); ++it)
      if (std::find(def.only_systems.begin(), it, *it) != it)
        return fault("a particle system is named twice");
    return {};
  }
  if (!def.pose.x.allFinite() || !def.pose.q.coeffs().allFinite())
    return fault("pose is not finite");
  if (is_flat(def.shape.form) != (def.kind == SensorKind::gate))
    return fault("gates are flat, and regions are not");
  for (int k = 0; k < 3; ++k) {
    const bool used = (axes_of(def.shape.form) >> k & 1) != 0;
    if (used && !(def.shape.half[k] > 0 && std::isfinite(def.shape.half[k])))
      return fault(fmt::format("its extents must be > 0, got half of {} m", def.shape.half[k]));
  }
  if (!(def.span > 0 && std::isfinite(def.span)))
    return fault(fmt::format("span must be > 0, got {} s", def.span));
  return {};
}

void write_sensor_def(ByteWriter& out, const SensorDef& def) {
  out.text(def.name);
  out.value(def.kind);
  out.value(def.shape.form);
  out.value(def.shape.half);
  out.value(def.carrier);
  out.value(def.pose.x);
  out.value(def.pose.q.coeffs());
  for (const bool flag : {def.bodies, def.particles}) out.value(uint8_t(flag));
  out.vector(def.only_bodies);
  out.vector(def.only_systems);
  out.value(def.span);
  out.value(def.a);
  out.value(def.b);
  out.value(def.range);
  out.value(def.shells);
}

SensorDef read_sensor_def(ByteReader& in) {
  SensorDef def;
  in.text(def.name);
  in.value(def.kind);
  in.value(def.shape.form);
  in.value(def.shape.half);
  in.value(def.carrier);
  in.value(def.pose.x);
  in.value(def.pose.q.coeffs());
  for (bool* flag : {&def.bodies, &def.particles}) *flag = in.get<uint8_t>() != 0;
  in.vector(def.only_bodies);
  in.vector(def.only_systems);
  in.value(def.span);
  in.value(def.a);
  in.value(def.b);
  in.value(def.range);
  in.value(def.shells);
  if (def.kind > SensorKind::radial || def.shape.form > SensorForm::cylinder || !validate(def))
    in.fail();
  return def;
}

void SensorSet::save(ByteWriter& out) const {
  ids.save(out);
  for (uint32_t i = 0; i < ids.capacity(); ++i) {
    if (!ids.alive(i)) continue;
    write_sensor_def(out, defs[i]);
    const SensorState& s = states[i];
    for (const double value : {s.begun, s.mass_forward, s.mass_backward, s.flow}) out.value(value);
    for (const uint64_t count : {s.forward, s.backward, s.touches}) out.value(count);
    out.vector(s.recent);
    out.value(uint8_t(s.touching));
    out.value(s.force);
  }
}

void SensorSet::load(ByteReader& in) {
  ids.load(in);
  defs.assign(in.ok() ? ids.capacity() : 0, {});
  states.assign(defs.size(), {});
  for (uint32_t i = 0; i < defs.size() && in.ok(); ++i) {
    if (!ids.alive(i)) continue;
    defs[i] = read_sensor_def(in);
    SensorState& s = states[i];
    for (double* value : {&s.begun, &s.mass_forward, &s.mass_backward, &s.flow}) in.value(*value);
    for (uint64_t* count : {&s.forward, &s.backward, &s.touches}) in.value(*count);
    in.vector(s.recent);
    s.touching = in.get<uint8_t>() != 0;
    in.value(s.force);
  }
}

}  // namespace tumble
