#pragma once
#include "engine/collision/time_of_contact.hpp"
#include "tests/collision/support.hpp"

#include <string>
#include <vector>

/// The answers of every method, and what all of them promise.
namespace tumble::test {

using Toc = TimeOfContactStatus;

struct Answer {
  std::string name;  ///< of the method asked
  TimeOfContact toc;
};

/// All methods; those that do not apply give the automatic answer.
inline std::vector<Answer> answers(const Shape& a, const Motion& ma, const Shape& b,
                                   const Motion& mb, double tolerance) {
  std::vector<Answer> out;
  for (const ContactTimeMethod& method : all_contact_time_methods()) {
    for (const bool v_clip : {false, true}) {
      TimeOfContactOptions options;
      options.method = &method;
      options.v_clip = v_clip;
      out.push_back({std::string(method.name), time_of_contact(a, ma, b, mb, tolerance, options)});
    }
  }
  return out;
}

/// What every answer promises.
inline void check_form(const TimeOfContact& t, const Motion& m, double tolerance) {
  REQUIRE(t.status != Toc::invalid);
  CHECK(t.certified);
  CHECK(!t.method.empty());
  CHECK(t.time == t.low);
  CHECK(t.low >= m.t0);
  CHECK(t.high >= t.low);
  CHECK(t.high <= m.t1);
  CHECK(t.distance_high >= 0);
  if (!t.hit()) return;
  CHECK(t.distance_low > 0.2 * tolerance);
  CHECK(t.distance_low <= tolerance);
  CHECK(std::abs(t.normal.norm() - 1) < 1e-9);
  CHECK((t.on_b - t.on_a).norm() <= 1.1 * tolerance);
  CHECK((t.on_b - t.on_a).dot(t.normal) > 0);
}

inline const ContactTimeMethod& method_named(std::string_view name) {
  for (const ContactTimeMethod& m : all_contact_time_methods()) {
    if (m.name == name) return m;
  }
  FAIL("no such method");
  return all_contact_time_methods().front();
}

}  // namespace tumble::test
