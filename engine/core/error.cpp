#include "engine/core/error.hpp"

#include <cstdio>
#include <cstdlib>

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
    case ErrorCode::cancelled:
      return "cancelled";
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

void no_value(const Error& error) {
  std::fprintf(stderr, "tumble: a value was asked for where there is an error: %s\n",
               error.text().c_str());
  std::abort();
}

void no_error() {
  std::fputs("tumble: an error was asked for where there is none\n", stderr);
  std::abort();
}

}  // namespace tumble
