#pragma once
#include <map>
#include <string>
#include <vector>

namespace tumble {

/// Where a value of the inspector belongs.
struct PinOwner {
  std::string body;    ///< its body, or a body of its joint
  std::string joint;   ///< "": the value is the body's
  std::string prefix;  ///< of its name: "shape.0.", or "angle." for a coordinate of the joint
};

/// A value that is pinned: it has a slider in Settings, whatever is selected.
struct Pin {
  std::string body, joint;
  std::string value;  ///< with its prefix: "mass", "shape.0.friction", "angle.target"
  bool operator==(const Pin&) const = default;
};

/// Ends of a slider.
struct SliderRange {
  double least = 0, most = 0;
};

/// The pinned values in the order in which they were pinned.
struct Pins {
  std::vector<Pin> all;
  /// Ends of their sliders by the names of their widgets; they stay while a value is between them.
  std::map<std::string, SliderRange> ranges;

  bool has(const Pin& pin) const;
  /// Pins a value, or takes it off.
  void flip(const Pin& pin);
};

/// Ends for a slider at `value`: twice as far as it, to either side if it may be negative, within
/// what it may be at all.
SliderRange slider_range(double value, double least, double most);

}  // namespace tumble
