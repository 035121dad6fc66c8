#pragma once
#include "engine/core/bytes.hpp"
#include "engine/math/expression.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// A number as a function of time, in a form that can be stored: an expression in `t`, or a table
/// with linear interpolation.
class TimeCourse {
 public:
  using Constants = std::vector<std::pair<std::string, double>>;
  using Points = std::vector<std::pair<double, double>>;

  /// An expression in the time `t` [s], `pi`, and the constants. Errors: those of
  /// Expression::parse, an unknown name, no finite value at t = 0.
  static Result<TimeCourse> expression(std::string text, Constants constants = {});
  /// (time [s], value), times ascending; constant before the first and after the last. Errors: no
  /// points, times that do not ascend, values that are not finite.
  static Result<TimeCourse> table(Points points);

  /// NaN if an expression has no finite value.
  double at(double t) const;
  /// Another expression of the same constants, without the factor. Errors: as of expression().
  Result<TimeCourse> with_text(std::string text) const;
  /// The same times a factor.
  TimeCourse scaled(double factor) const;

  /// The expression without the factor; empty for a table.
  const std::string& text() const { return text_; }
  const Points& points() const { return points_; }

  void write(ByteWriter& out) const;
  /// Returns null and fails the reader on invalid bytes.
  static std::shared_ptr<const TimeCourse> read(ByteReader& in);

 private:
  std::string text_;
  Constants constants_;
  Expression expression_;
  Points points_;
  double factor_ = 1;
};

/// A course or null: the first byte says whether there is one.
void write_course(ByteWriter& out, const std::shared_ptr<const TimeCourse>& course);
std::shared_ptr<const TimeCourse> read_course(ByteReader& in);

}  // namespace tumble
