#pragma once
#include <string>
#include <string_view>

namespace tumble {

/// Kind of an Error; determines the exit code of the program.
enum class ErrorCode {
  invalid_argument,  ///< a caller's value is out of range
  not_found,         ///< a name, file or stale id
  parse,             ///< a file's text or structure is wrong
  io,                ///< reading or writing failed
  unsupported,       ///< understood, but not possible here
  numeric,           ///< a non-finite value or an unverified solve
  cancelled,         ///< a stop was requested; everything is as before
  internal,          ///< a broken invariant of our own
};

std::string_view to_string(ErrorCode code);

/// A fault that a user can act on: what is wrong, where, and how to correct it.
struct Error {
  ErrorCode code = ErrorCode::internal;
  std::string message;  ///< what is wrong, with the offending value: "radius must be > 0, got -1 m"
  std::string place;    ///< file:line, JSON path, body or contact; empty when there is none
  std::string cure;     ///< what to do about it; empty when the message says it

  /// "place: message (cure)", without the parts that are empty.
  std::string text() const;
};

/// Ends the program with a message: the value of a Result was read, which has an error instead.
[[noreturn]] void no_value(const Error& error);
/// Ends the program: the error of a Result was read, which has a value instead.
[[noreturn]] void no_error();

}  // namespace tumble
