#include "engine/core/error.hpp"

namespace tumble {

std::string_view to_string(ErrorCode code) {
  switch (code) {
    case ErrorCode::invalid_argument:
      return "invalid argument";
    case ErrorCode::not_found:
      return "not found";
    case ErrorCode::parse:
      return "parse error";
    case ErrorCode::io:
      return "input/output error";
    case ErrorCode::unsupported:
      return "unsupported";
    case ErrorCode::numeric:
      return "numerical breakdown";
    case ErrorCode::internal:
      return "internal error";
  }
  return "unknown error";
}

std::string Error::text() const {
  std::string out;
  if (!place.empty()) out += place + ": ";
  out += message;
  if (!cure.empty()) out += " (" + cure + ")";
  return out;
}

}  // namespace tumble
