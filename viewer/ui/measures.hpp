#pragma once
#include "engine/world/frame.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Something that can be read from every frame: the height of a body, the angle of a joint.
struct Quantity {
  std::string name;  ///< "ball: height"
  std::string unit;
  /// Nothing where it does not exist (any more).
  std::function<std::optional<double>(const Frame&)> read;
};

/// What can be measured of a body and of the joints at it.
std::vector<Quantity> quantities_of(const Frame& frame, BodyId body);

/// What the sensors of the scene say.
std::vector<Quantity> quantities_of_sensors(const Frame& frame);

/// That of one of the two lists which has this name; nothing when there is none.
std::optional<Quantity> quantity_of_name(const Frame& frame, const std::string& name);

/// Quantities that a person watches, each with its recent past: a value a published tick. Going
/// back in time keeps what lies ahead, as the line of time does, until that will not come any more.
class Measures {
 public:
  /// Values of one quantity [ticks]: a minute at 60 Hz.
  static constexpr size_t capacity = 3600;
  static constexpr size_t most = 12;

  struct Series {
    Quantity quantity;
    std::vector<double> at;  ///< ascending [s]
    std::vector<float> values;
    bool wants_past = false;  ///< it was not watched from the start, and that can be made good
  };

  /// One more; a quantity of that name is not added twice.
  void add(Quantity quantity, const Frame& now);
  /// Somebody went where nobody has seen the way to, or has watched for a while only: all of them
  /// want their past. Until fill() or forget_past().
  void want_past();
  void want_past(size_t index) { series_.at(index).wants_past = true; }
  void forget_past();
  /// The past of one of them (ascending times), where it has no value yet.
  void fill(const std::string& name, const std::vector<double>& at,
            const std::vector<float>& values);
  void remove(size_t index);
  /// Once for every new frame. `ahead`: what was seen after it will come once more.
  void see(const Frame& frame, bool ahead);
  /// Forgets the past, and goes on with the same quantities.
  void restart();
  void clear() { series_.clear(); }
  const std::vector<Series>& series() const { return series_; }
  /// "time [s],ball: height [m],..." and a row a time; empty cells where a quantity had no value.
  std::string csv() const;

 private:
  std::vector<Series> series_;
};

}  // namespace tumble
