#include "engine/dynamics/contact/contact_certificate.hpp"

namespace tumble {

std::string_view to_string(ContactMode mode) {
  switch (mode) {
    case ContactMode::open:
      return "open";
    case ContactMode::sticking:
      return "sticking";
    case ContactMode::sliding:
      return "sliding";
  }
  return "unknown";
}

}  // namespace tumble
