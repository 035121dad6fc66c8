#pragma once
#include "viewer/app/session/session.hpp"
#include "viewer/ui/contact_view.hpp"

#include <memory>

namespace tumble {

/// Keeps one contact under examination: asks the world what it claims, picture after picture, and
/// follows it as its bodies move. Answers come from the simulation thread; there is one question
/// under way at a time, so that a world that answers slowly is not held up by many.
class ContactProbe {
 public:
  void choose(const ContactPick& pick);
  void clear();
  bool active() const { return chosen_; }
  /// Takes the answer that has come, and asks again when the picture is another one.
  void update(Session& session, const std::shared_ptr<const Frame>& frame);
  /// What was last heard; null when nothing was chosen or nothing has been heard yet.
  const ContactView* view() const { return known_ ? &*known_ : nullptr; }

 private:
  struct Answer;

  bool chosen_ = false;
  ContactPick pick_;
  std::optional<ContactView> known_;
  std::shared_ptr<const Frame> asked_for_;
  std::shared_ptr<Answer> pending_;
};

}  // namespace tumble
