#pragma once
#include "engine/core/bytes.hpp"
#include "engine/math/expression.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// A number over time, as data that can be stored: an expression in `t`, or a table of values that
/// straight lines join.
class TimeCourse {
 public:
  using Constants = std::vector<std::pair<std::string, double>>;
  using Points = std::vector<std::pair<double, double>>;

  /// Of the time `t` [s], `pi`, and the constants. Errors: what Expression::parse says, a name that
  /// is none of these, no finite value at t = 0.
  static Result<TimeCourse> expression(std::string text, Constants constants = {});
  /// (time [s], value), times ascending; before the first and after the last the value stays.
  /// Errors: no points, a time that is not later than the one before, what is not finite.
  static Result<TimeCourse> table(Points points);

  /// NaN where an expression has no finite value.
  double at(double t) const;
  /// Another expression of the same constants, without the factor. Errors: as of expression().
  Result<TimeCourse> with_text(std::string text) const;
  /// The same times a factor.
  TimeCourse scaled(double factor) const;

  /// Of an expression, without the factor; empty of a table.
  const std::string& text() const { return text_; }
  const Points& points() const { return points_; }

  void write(ByteWriter& out) const;
  /// Null, and a failed reader, on bytes that are none.
  static std::shared_ptr<const TimeCourse> read(ByteReader& in);

 private:
  std::string text_;
  Constants constants_;
  Expression expression_;
  Points points_;
  double factor_ = 1;
};

/// A course or none: its bytes begin with whether there is one.
void write_course(ByteWriter& out, const std::shared_ptr<const TimeCourse>& course);
std::shared_ptr<const TimeCourse> read_course(ByteReader& in);

}  // namespace tumble
