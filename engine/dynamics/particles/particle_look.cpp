#include "engine/dynamics/particles/particle_look.hpp"

#include "engine/dynamics/particles/particle_system.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

double quantity_of(const ParticleSystem& p, ParticleQuantity quantity, size_t i) {
  switch (quantity) {
    case ParticleQuantity::none:
      return 0;
    case ParticleQuantity::speed:
      return p.v[i].norm();
    case ParticleQuantity::age:
      return p.age[i];
    case ParticleQuantity::density:
      return p.fluid ? p.density[i] : 0;
    case ParticleQuantity::pressure:
      return p.pressure[i];
  }
  return 0;
}

}  // namespace

QuantityName name_of(ParticleQuantity quantity) {
  switch (quantity) {
    case ParticleQuantity::none:
      return {"", ""};
    case ParticleQuantity::speed:
      return {"speed", "m/s"};
    case ParticleQuantity::age:
      return {"age", "s"};
    case ParticleQuantity::density:
      return {"density", "kg/m3"};
    case ParticleQuantity::pressure:
      return {"pressure", "Pa"};
  }
  return {"", ""};
}

Status validate(const ParticleLook& look, bool fluid) {
  const auto fault = [](std::string message, std::string cure) {
    return Error{ErrorCode::invalid_argument, std::move(message), "look", std::move(cure)};
  };
  if (look.colour_by != ParticleQuantity::none && look.style != ParticleStyle::spheres)
    return fault("only spheres are coloured by a quantity", "leave out colour_by, or the style");
  const bool of_fluids =
      look.colour_by == ParticleQuantity::density || look.colour_by == ParticleQuantity::pressure;
  if (of_fluids && !fluid)
    return fault(
        fmt::format("particles that are no fluid have no {}", name_of(look.colour_by).name),
        "colour by speed or age, or give the system a fluid");
  if (!std::isfinite(look.low) || !std::isfinite(look.high) || look.low > look.high)
    return fault(fmt::format("the range of colours must rise, got {} to {}", look.low, look.high),
                 "give the smaller value first");
  if (!(look.clarity >= 0) || !std::isfinite(look.clarity))
    return fault(fmt::format("clarity must be >= 0, got {} m", look.clarity), "");
  if (!(look.trail >= 0) || !std::isfinite(look.trail))
    return fault(fmt::format("trail must be >= 0, got {} s", look.trail), "");
  for (const auto& [name, share] : {std::pair{"foam", look.foam}, {"opacity", look.opacity}})
    if (!(share >= 0 && share <= 1))
      return fault(fmt::format("{} must be in 0..1, got {}", name, share), "");
  return {};
}

void save(ByteWriter& out, const ParticleLook& look) {
  out.value(uint8_t(look.style));
  out.value(uint8_t(look.colour_by));
  out.value(look.low);
  out.value(look.high);
  for (const double value : {look.clarity, look.foam, look.opacity, look.trail}) out.value(value);
}

ParticleLook load_particle_look(ByteReader& in) {
  ParticleLook look;
  look.style = ParticleStyle(in.get<uint8_t>());
  look.colour_by = ParticleQuantity(in.get<uint8_t>());
  in.value(look.low);
  in.value(look.high);
  for (double* value : {&look.clarity, &look.foam, &look.opacity, &look.trail}) in.value(*value);
  if (look.style > ParticleStyle::smoke || look.colour_by > ParticleQuantity::pressure) in.fail();
  return look;
}

void quantity_values(const ParticleSystem& p, ParticleQuantity quantity, std::vector<float>& out) {
  out.clear();
  if (quantity == ParticleQuantity::none) return;
  out.reserve(p.x.capacity());
  for (size_t i = 0; i < p.size(); ++i) out.push_back(float(quantity_of(p, quantity, i)));
}

void note_quantity(ParticleSystem& p) {
  if (!p.look.finds_range()) return;
  for (size_t i = 0; i < p.size(); ++i)
    if (const double value = quantity_of(p, p.look.colour_by, i); std::isfinite(value))
      p.seen.include(value);
}

}  // namespace tumble
