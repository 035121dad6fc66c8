#include "engine/math/time_course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

Error no_course(std::string message) {
  return {ErrorCode::invalid_argument, std::move(message), {}, {}};
}

}  // namespace

Result<TimeCourse> TimeCourse::expression(std::string text, Constants constants) {
  auto parsed = Expression::parse(text);
  if (!parsed) return parsed.error();
  TimeCourse out;
  for (const std::string& name : parsed->names()) {
    if (name == "t") continue;
    const auto known = std::ranges::find(constants, name, &Constants::value_type::first);
    if (known == constants.end()) return no_course("'" + name + "' is neither t nor a constant");
    out.constants_.push_back(*known);
  }
  out.text_ = std::move(text);
  out.expression_ = *std::move(parsed);
  if (!std::isfinite(out.at(0))) return no_course("'" + out.text_ + "' is not finite at t = 0");
  return out;
}

Result<TimeCourse> TimeCourse::table(Points points) {
  if (points.empty()) return no_course("a table over time needs at least one [time, value]");
  for (size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].first) || !std::isfinite(points[i].second))
      return no_course("times and values must be finite");
    if (i > 0 && !(points[i].first > points[i - 1].first))
      return no_course(fmt::format("times must ascend: {} s comes after {} s", points[i].first,
                                   points[i - 1].first));
  }
  TimeCourse out;
  out.points_ = std::move(points);
  return out;
}

double TimeCourse::at(double t) const {
  if (points_.empty()) {
    const auto value = expression_.evaluate([&](std::string_view name) -> std::optional<double> {
      if (const auto known = std::ranges::find(constants_, name, &Constants::value_type::first);
          known != constants_.end())
        return known->second;
      return name == "t" ? std::optional(t) : std::nullopt;
    });
    return value ? factor_ * *value : std::numeric_limits<double>::quiet_NaN();
  }
  const auto after = std::ranges::upper_bound(points_, t, {}, &Points::value_type::first);
  if (after == points_.begin()) return factor_ * points_.front().second;
  if (after == points_.end()) return factor_ * points_.back().second;
  const auto& [t0, v0] = *(after - 1);
  const auto& [t1, v1] = *after;
  return factor_ * (v0 + (t - t0) / (t1 - t0) * (v1 - v0));
}

Result<TimeCourse> TimeCourse::with_text(std::string text) const {
  return expression(std::move(text), constants_);
}

TimeCourse TimeCourse::scaled(double factor) const {
  TimeCourse out = *this;
  out.factor_ *= factor;
  return out;
}

void TimeCourse::write(ByteWriter& out) const {
  out.text(text_);
  out.value(factor_);
  out.value(uint64_t(constants_.size()));
  for (const auto& [name, value] : constants_) {
    out.text(name);
    out.value(value);
  }
  out.value(uint64_t(points_.size()));
  for (const auto& [t, value] : points_) {
    out.value(t);
    out.value(value);
  }
}

std::shared_ptr<const TimeCourse> TimeCourse::read(ByteReader& in) {
  std::string text;
  in.text(text);
  const auto factor = in.get<double>();
  Constants constants;
  const auto names = in.get<uint64_t>();
  for (uint64_t i = 0; i < names && in.ok(); ++i) {
    auto& [name, value] = constants.emplace_back();
    in.text(name);
    in.value(value);
  }
  Points points;
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    auto& [t, value] = points.emplace_back();
    in.value(t);
    in.value(value);
  }
  if (!in.ok()) return nullptr;
  auto made =
      points.empty() ? expression(std::move(text), std::move(constants)) : table(std::move(points));
  if (!made) {
    in.fail();
    return nullptr;
  }
  return std::make_shared<const TimeCourse>(made->scaled(factor));
}

void write_course(ByteWriter& out, const std::shared_ptr<const TimeCourse>& course) {
  out.value(uint8_t{course != nullptr});
  if (course) course->write(out);
}

std::shared_ptr<const TimeCourse> read_course(ByteReader& in) {
  return in.get<uint8_t>() != 0 ? TimeCourse::read(in) : nullptr;
}

}  // namespace tumble
