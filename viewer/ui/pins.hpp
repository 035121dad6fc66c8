#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Where a value of the inspector belongs.
struct PinOwner {
  std::string body;    ///< its body, or a body of its joint
  std::string joint;   ///< "": the value is the body's
  std::string prefix;  ///< of its name: "shape.0.", or "angle." for a coordinate of the joint
};

/// A value that is pinned: it stands in Settings, whatever is selected.
struct Pin {
  std::string body, joint;
  std::string value;  ///< with its prefix: "mass", "shape.0.friction", "angle.target"
  /// A joint has a name of its own: it is the same through either of its bodies.
  bool operator==(const Pin& other) const {
    return joint == other.joint && value == other.value && (!joint.empty() || body == other.body);
  }
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
  /// To be called when an item of the scene's "bodies" or "joints" gets another name.
  void rename(std::string_view list, const std::string& from, const std::string& to);
};

/// What `name` becomes when an item gets another name: that of the item itself, or of its copies
/// "brick[3]".
std::string renamed_item(const std::string& name, const std::string& from, const std::string& to);

/// Ends for a slider at `value`: twice as far as it, to either side if it may be negative, within
/// what it may be at all.
SliderRange slider_range(double value, double least, double most);

}  // namespace tumble
