#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace tumble {

/// Wall time of one named stage of a step or of a frame. Never part of state, hash or snapshot.
struct StageTime {
  std::string_view name;  ///< a string literal
  double seconds = 0;     ///< [s]
};

/// The stages of a step or of a frame, in the order of their first occurrence. Stored in place,
/// since every step copies them without allocating.
class StageTimes {
 public:
  static constexpr size_t most = 24;

  void clear() { size_ = 0; }
  /// Adds to the stage of this name, or appends it; if there are too many stages, adds to the last
  /// one.
  void add(std::string_view name, double seconds);

  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const StageTime* begin() const { return times_.data(); }
  const StageTime* end() const { return times_.data() + size_; }

 private:
  std::array<StageTime, most> times_;
  size_t size_ = 0;
};

}  // namespace tumble
