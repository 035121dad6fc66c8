#pragma once
#include "engine/math/time_course.hpp"
#include "engine/math/types.hpp"

#include <array>
#include <memory>
#include <utility>

namespace tumble {

/// A number that may follow a course over time. It reads as what it is now; go_to() says when that
/// is.
struct Varying {
  double value = 0;
  std::shared_ptr<const TimeCourse> course;  ///< null: it stays as it is

  Varying() = default;
  Varying(double constant) : value(constant) {}
  Varying(TimeCourse over_time)
      : value(over_time.at(0)), course(std::make_shared<const TimeCourse>(std::move(over_time))) {}

  operator double() const { return value; }
  bool varies() const { return course != nullptr; }
  bool differs_at(double t) const { return course && course->at(t) != value; }
  void go_to(double t) {
    if (course) value = course->at(t);
  }
};

/// A vector each of whose components may.
struct VaryingVec3 {
  std::array<Varying, 3> of;

  VaryingVec3() = default;
  VaryingVec3(const Vec3& constant) : of{constant.x(), constant.y(), constant.z()} {}
  VaryingVec3(Varying x, Varying y, Varying z) : of{std::move(x), std::move(y), std::move(z)} {}

  Vec3 now() const { return {of[0].value, of[1].value, of[2].value}; }
  bool varies() const { return of[0].varies() || of[1].varies() || of[2].varies(); }
  bool differs_at(double t) const {
    return of[0].differs_at(t) || of[1].differs_at(t) || of[2].differs_at(t);
  }
  void go_to(double t) {
    for (Varying& x : of) x.go_to(t);
  }
};

}  // namespace tumble
