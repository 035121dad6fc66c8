#pragma once
#include "engine/world/frame.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A quantity that can be read from every frame, such as the height of a body or the angle of a
/// joint.
struct Quantity {
  std::string name;  ///< "ball: height"
  std::string unit;
  /// Empty if the thing it refers to does not exist (any more).
  std::function<std::optional<double>(const Frame&)> read;
};

/// The quantities of a body and of its joints.
std::vector<Quantity> quantities_of(const Frame& frame, BodyId body);

/// The readings of the scene's sensors.
std::vector<Quantity> quantities_of_sensors(const Frame& frame);

/// The quantity of this name from either list; empty if there is none.
std::optional<Quantity> quantity_of_name(const Frame& frame, const std::string& name);

/// Quantities being plotted, each with its recent past: one value per published tick. Going back in
/// time keeps later values, as the time line does, until the run takes another course.
class Measures {
 public:
  /// Number of values kept per quantity [ticks]: a minute at 60 Hz.
  static constexpr size_t capacity = 3600;
  static constexpr size_t most = 12;

  struct Series {
    Quantity quantity;
    std::vector<double> at;  ///< ascending [s]
    std::vector<float> values;
    bool wants_past = false;  ///< values from before it was added are missing and can be computed
  };

  /// Adds a quantity, unless one of that name exists.
  void add(Quantity quantity, const Frame& now);
  /// Marks the past of all quantities as missing, after a jump over ticks that were not seen; until
  /// fill() or forget_past().
  void want_past();
  void want_past(size_t index) { series_.at(index).wants_past = true; }
  void forget_past();
  /// Supplies past values of one quantity (ascending times) where it has none yet.
  void fill(const std::string& name, const std::vector<double>& at,
            const std::vector<float>& values);
  void remove(size_t index);
  /// To be called for every new frame. `ahead`: what was seen after this frame will happen again,
  /// so later values stay valid.
  void see(const Frame& frame, bool ahead);
  /// Drops all values but keeps the quantities.
  void restart();
  void clear() { series_.clear(); }
  const std::vector<Series>& series() const { return series_; }
  /// CSV with the header "time [s],ball: height [m],..." and a row per time; cells are empty where
  /// a quantity has no value.
  std::string csv() const;

 private:
  std::vector<Series> series_;
};

}  // namespace tumble
