#pragma once
#include <cstdint>

namespace tumble {

/// Ticks per second as a fraction; time is n * den / num, computed and never accumulated.
struct TickRate {
  int64_t num = 60;
  int64_t den = 1;

  double tick() const { return double(den) / double(num); }                        ///< [s]
  double time(uint64_t n) const { return double(n) * double(den) / double(num); }  ///< [s]
  friend bool operator==(const TickRate&, const TickRate&) = default;
};

}  // namespace tumble
