#pragma once
#include "viewer/render/overlays.hpp"

namespace tumble {

/// Overlays that the page of a lesson has switched on: they go with it, while those that a person
/// chose stay.
class LessonOverlays {
 public:
  /// The lesson ends; what the scene wants stays, too.
  void end(const Overlays& of_scene, Overlays& shown) {
    for (const OverlayEntry& entry : all_overlays()) {
      const auto on = entry.enabled;
      if (own_.*on && !(of_scene.*on)) shown.*on = false;
    }
    own_ = {};
  }
  /// Another page is shown.
  void turn_to(const Overlays& wanted, Overlays& shown) {
    for (const OverlayEntry& entry : all_overlays()) {
      const auto on = entry.enabled;
      const bool others = shown.*on && !(own_.*on);
      shown.*on = others || wanted.*on;
      own_.*on = wanted.*on && !others;
    }
  }

 private:
  Overlays own_;
};

}  // namespace tumble
