#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/ui/ui_state.hpp"

#include <future>
#include <memory>

namespace tumble {

/// The definitions of the selected body and its joints, queried from the world whenever the
/// selection or the definition of any body has changed. At most one query is under way.
class SelectedDef {
 public:
  using Joints = std::vector<SelectedJoint>;

  /// Takes an answer that has arrived, and sends a new query if it is outdated.
  void update(Session& session, const Frame& frame, BodyId selected);
  /// Shows the effect of an edit before the world has executed it.
  void expect(const EditBody& edit);
  void expect(const EditJoint& edit);
  /// Forces a new query.
  void ask_again() { asked_with_ = nullptr; }
  /// Null if nothing is selected, or not known yet.
  std::shared_ptr<const BodyDef> def() const { return def_; }
  /// The joints at the body by slot; null if nothing is selected, or not known yet.
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
  BodyId asked_;  ///< the body of the last query
  /// And the state of all bodies when it was sent.
  std::shared_ptr<const std::vector<BodyInfo>> asked_with_;
};

}  // namespace tumble
