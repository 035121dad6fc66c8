#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/parameters.hpp"
#include "engine/dynamics/forces/anchor.hpp"
#include "engine/math/types.hpp"
#include "engine/math/varying.hpp"
#include "engine/world/time.hpp"

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

/// Building blocks of the byte form of definitions. Readers call fail() on anything that is not
/// valid.
namespace tumble::byte_parts {

inline void write_varying(ByteWriter& out, const Varying& number) {
  out.value(number.value);
  write_course(out, number.course);
}

inline void read_varying(ByteReader& in, Varying& number) {
  in.value(number.value);
  number.course = read_course(in);
}

/// Writes every declared parameter of a struct in the order of its declaration.
struct WriteParameters {
  ByteWriter& out;
  template <class T>
  void field(const T& value, const Parameter&) {
    if constexpr (std::is_same_v<T, std::string>) {
      out.text(value);
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      out.vector(value);
    } else if constexpr (std::is_same_v<T, TickRate>) {
      out.value(value.num);
      out.value(value.den);
    } else if constexpr (std::is_same_v<T, Varying>) {
      write_varying(out, value);
    } else if constexpr (std::is_same_v<T, VaryingVec3>) {
      for (const Varying& x : value.of) write_varying(out, x);
    } else {
      out.value(value);
    }
  }
  template <class T>
  void object(const T& value, const Parameter&) {
    T::parameters(*this, value);
  }
};

struct ReadParameters {
  ByteReader& in;
  template <class T>
  void field(T& value, const Parameter&) {
    if constexpr (std::is_same_v<T, std::string>) {
      in.text(value);
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      in.vector(value);
    } else if constexpr (std::is_same_v<T, TickRate>) {
      in.value(value.num);
      in.value(value.den);
    } else if constexpr (std::is_same_v<T, Varying>) {
      read_varying(in, value);
    } else if constexpr (std::is_same_v<T, VaryingVec3>) {
      for (Varying& x : value.of) read_varying(in, x);
    } else {
      in.value(value);
    }
  }
  template <class T>
  void object(T& value, const Parameter&) {
    T::parameters(*this, value);
  }
};

inline void write_pose(ByteWriter& out, const Pose& pose) {
  out.value(pose.x);
  out.value(pose.q.coeffs());
}

inline void read_pose(ByteReader& in, Pose& pose) {
  in.value(pose.x);
  in.value(pose.q.coeffs());
}

inline void write_anchor(ByteWriter& out, const Anchor& a) {
  out.value(a.kind);
  out.value(a.body);
  out.value(a.particles);
  out.value(a.particle);
  out.value(a.point);
}

inline void read_anchor(ByteReader& in, Anchor& a) {
  in.value(a.kind);
  in.value(a.body);
  in.value(a.particles);
  in.value(a.particle);
  in.value(a.point);
  if (a.kind > Anchor::Kind::particle) in.fail();
}

template <class T>
void write_array(ByteWriter& out, const std::vector<T>& values) {
  out.value(uint64_t(values.size()));
  for (const T& v : values) out.value(v);
}

template <class T>
void read_array(ByteReader& in, std::vector<T>& values) {
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) in.value(values.emplace_back());
}

/// The alternative of a variant with this index, default-constructed; nullopt for an index out of
/// range.
template <class Variant, size_t I = 0>
std::optional<Variant> alternative(size_t index) {
  if constexpr (I < std::variant_size_v<Variant>) {
    if (index == I) return Variant(std::in_place_index<I>);
    return alternative<Variant, I + 1>(index);
  }
  return std::nullopt;
}

/// A variant of structs that declare their parameters: the index of the alternative, then its
/// parameters.
template <class Variant>
void write_variant(ByteWriter& out, const Variant& value) {
  out.value(uint8_t(value.index()));
  WriteParameters write{out};
  std::visit([&](const auto& d) { std::decay_t<decltype(d)>::parameters(write, d); }, value);
}

template <class Variant>
Variant read_variant(ByteReader& in) {
  const auto made = alternative<Variant>(in.get<uint8_t>());
  if (!made) in.fail();
  Variant value = made.value_or(Variant{});
  ReadParameters read{in};
  std::visit([&](auto& d) { std::decay_t<decltype(d)>::parameters(read, d); }, value);
  return value;
}

inline bool read_flag(ByteReader& in) {
  return in.get<uint8_t>() != 0;
}

template <class T>
void write_optional(ByteWriter& out, const std::optional<T>& value) {
  out.value(uint8_t{value.has_value()});
  if (value) out.value(*value);
}

template <class T>
void read_optional(ByteReader& in, std::optional<T>& value) {
  value.reset();
  if (read_flag(in)) in.value(value.emplace());
}

}  // namespace tumble::byte_parts
