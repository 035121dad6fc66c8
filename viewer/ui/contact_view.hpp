#pragma once
#include "engine/dynamics/contact/contact_certificate.hpp"
#include "viewer/interact/contact_picking.hpp"

#include <optional>
#include <string>

namespace tumble {

/// Information about the contact selected for inspection.
struct ContactView {
  ContactPick pick;
  std::optional<ContactCertificate> certificate;  ///< none while the two do not touch
  /// Only for dynamic bodies under the event stepper.
  std::optional<BodyBalance> balance_a, balance_b;
  std::string refusal;  ///< why there is no information; empty if there is
};

}  // namespace tumble
