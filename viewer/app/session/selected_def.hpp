#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/ui/ui_state.hpp"

#include <future>
#include <memory>

namespace tumble {

/// The definitions of the selected body and of its joints, asked from the world whenever the
/// selection or anything that bodies are made of has changed. One question is under way at a time.
class SelectedDef {
 public:
  using Joints = std::vector<SelectedJoint>;

  /// Takes the answer that has come, and asks anew where it would be another.
  void update(Session& session, const Frame& frame, BodyId selected);
  /// Shows a change before the world has made it.
  void expect(const EditBody& edit);
  void expect(const EditJoint& edit);
  /// Asks anew, whatever has changed.
  void ask_again() { asked_with_ = nullptr; }
  /// Null while nothing is selected, or nothing is known yet.
  std::shared_ptr<const BodyDef> def() const { return def_; }
  /// Those at the body, in the order of their slots; null likewise.
  std::shared_ptr<const Joints> joints() const { return joints_; }
  void forget() { *this = SelectedDef{}; }

 private:
  struct Known {
    std::shared_ptr<const BodyDef> def;
    std::shared_ptr<const Joints> joints;
  };
  std::future<Known> answer_;
  std::shared_ptr<const BodyDef> def_;
  std::shared_ptr<const Joints> joints_;
  BodyId asked_;                                             ///< for this body,
  std::shared_ptr<const std::vector<BodyInfo>> asked_with_;  ///< when this was known of it
};

}  // namespace tumble
