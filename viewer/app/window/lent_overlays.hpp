#pragma once
#include "viewer/render/overlays.hpp"

namespace tumble {

/// Overlays that a lesson's page or a tool has switched on. They are switched off when it ends,
/// whereas overlays that the user has switched on stay.
class LentOverlays {
 public:
  /// Switches them off, except those that the scene wants.
  void end(const Overlays& of_scene, Overlays& shown) {
    for (const OverlayEntry& entry : all_overlays()) {
      const auto on = entry.enabled;
      if (own_.*on && !(of_scene.*on)) shown.*on = false;
    }
    own_ = {};
  }
  /// Switches on an overlay.
  void switch_on(bool Overlays::*overlay, Overlays& shown) {
    own_.*overlay = own_.*overlay || !(shown.*overlay);
    shown.*overlay = true;
  }
  /// Changes the set of overlays, for another page.
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
