#pragma once
#include "viewer/render/overlays.hpp"

namespace tumble {

/// Overlays that something has switched on, the page of a lesson or a tool: they go with it, while
/// those that a person chose stay.
class LentOverlays {
 public:
  /// It ends; what the scene wants stays, too.
  void end(const Overlays& of_scene, Overlays& shown) {
    for (const OverlayEntry& entry : all_overlays()) {
      const auto on = entry.enabled;
      if (own_.*on && !(of_scene.*on)) shown.*on = false;
    }
    own_ = {};
  }
  /// One more.
  void switch_on(bool Overlays::*overlay, Overlays& shown) {
    own_.*overlay = own_.*overlay || !(shown.*overlay);
    shown.*overlay = true;
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
