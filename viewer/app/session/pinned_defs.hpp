#pragma once
#include "viewer/app/session/selected_def.hpp"
#include "viewer/ui/pins.hpp"

#include <map>
#include <string>

namespace tumble {

/// The definitions of the bodies that have pinned values, and of their joints, by the bodies'
/// names.
class PinnedDefs {
 public:
  void update(Session& session, const Frame& frame, const Pins& pins);
  /// Shows the effect of an edit before the world has executed it.
  template <class Edit>
  void expect(const Edit& edit) {
    for (auto& [name, body] : bodies_) body.known.expect(edit);
  }
  std::map<std::string, PinnedBody> all() const;
  void forget() { bodies_.clear(); }

 private:
  struct Body {
    BodyId id;
    SelectedDef known;
  };
  std::map<std::string, Body> bodies_;
};

}  // namespace tumble
