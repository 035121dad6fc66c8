#pragma once
#include "viewer/app/session/session.hpp"
#include "viewer/ui/contact_view.hpp"

#include <memory>

namespace tumble {

/// Inspects one contact: queries its certificate for every picture and follows the contact while
/// its bodies move. The simulation thread answers; there is at most one query under way, so that a
/// slow world is not delayed further by many.
class ContactProbe {
 public:
  void choose(const ContactPick& pick);
  void clear();
  bool active() const { return chosen_; }
  /// Takes an answer that has arrived, and sends a new query if the frame has changed.
  void update(Session& session, const std::shared_ptr<const Frame>& frame);
  /// The last answer; null if no contact is chosen or there is no answer yet.
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
