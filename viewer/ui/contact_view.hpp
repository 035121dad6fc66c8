#pragma once
#include "engine/dynamics/contact/contact_certificate.hpp"
#include "viewer/interact/contact_picking.hpp"

#include <optional>
#include <string>

namespace tumble {

/// What is known of the contact that a person looks at.
struct ContactView {
  ContactPick pick;
  std::optional<ContactCertificate> certificate;  ///< none while the two do not touch
  /// Of the bodies that have one: dynamic ones under the event stepper.
  std::optional<BodyBalance> balance_a, balance_b;
  std::string refusal;  ///< why nothing is known; empty when something is
};

}  // namespace tumble
