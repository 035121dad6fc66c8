#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "viewer/app/session.hpp"
#include "viewer/ui/ui_state.hpp"

#include <future>
#include <memory>

namespace tumble {

/// The definition of the selected body, asked from the world whenever the selection or anything
/// that bodies are made of has changed. One question is under way at a time.
class SelectedDef {
 public:
  /// Takes the answer that has come, and asks anew where it would be another.
  void update(Session& session, const Frame& frame, BodyId selected);
  /// Shows a change before the world has made it.
  void expect(const EditBody& edit);
  /// Null while nothing is selected, or nothing is known yet.
  std::shared_ptr<const BodyDef> def() const { return def_; }
  void forget() { *this = SelectedDef{}; }

 private:
  std::future<std::shared_ptr<const BodyDef>> answer_;
  std::shared_ptr<const BodyDef> def_;
  BodyId asked_;                                             ///< for this body,
  std::shared_ptr<const std::vector<BodyInfo>> asked_with_;  ///< when this was known of it
};

}  // namespace tumble
