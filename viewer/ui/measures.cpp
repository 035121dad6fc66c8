#include "viewer/ui/measures.hpp"

#include "viewer/interact/picking.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>

#include <fmt/format.h>

namespace tumble {
namespace {

struct OfBody {
  const char *name, *unit;
  double (*value)(const BodyFrame&, const BodyInfo&, const Frame&);
};
using B = const BodyFrame&;
using I = const BodyInfo&;
using F = const Frame&;
constexpr OfBody of_bodies[] = {
    {"x", "m", [](B b, I, F) { return b.pose.x.x(); }},
    {"height", "m", [](B b, I, F) { return b.pose.x.y(); }},
    {"z", "m", [](B b, I, F) { return b.pose.x.z(); }},
    {"speed", "m/s", [](B b, I, F) { return b.v.norm(); }},
    {"velocity x", "m/s", [](B b, I, F) { return b.v.x(); }},
    {"velocity y", "m/s", [](B b, I, F) { return b.v.y(); }},
    {"velocity z", "m/s", [](B b, I, F) { return b.v.z(); }},
    {"spin", "rad/s", [](B b, I, F) { return b.omega.norm(); }},
    {"kinetic energy", "J", [](B b, I i, F) { return kinetic_energy(b, i); }},
    {"force of contacts", "N",
     [](B b, I, F f) {
       Vec3 sum = Vec3::Zero();
       f.for_contacts([&](const ContactFrame& c) {
         if (c.b == b.id) sum += c.impulse;
         if (c.a == b.id) sum -= c.impulse;
       });
       return sum.norm() / f.rate.tick();
     }},
};

const JointFrame* find_joint(const Frame& frame, JointId id) {
  if (!frame.joints) return nullptr;
  for (const JointFrame& j : *frame.joints)
    if (j.id == id) return &j;
  return nullptr;
}

void add_joint(const JointFrame& joint, std::vector<Quantity>& out) {
  const std::string name =
      joint.name.empty() ? fmt::format("joint {}", joint.id.index) : joint.name;
  const auto add = [&](const std::string& what, const char* unit, auto value) {
    out.push_back({name + ": " + what, unit, [id = joint.id, value](F f) -> std::optional<double> {
                     const JointFrame* j = find_joint(f, id);
                     return j ? std::optional(value(*j)) : std::nullopt;
                   }});
  };
  const auto& coordinates = entry_of(joint.kind).coordinates;
  for (size_t k = 0; k < coordinates.size(); ++k) {
    const std::string what(coordinates[k].name);
    const bool angle = coordinates[k].angle;
    add(what, angle ? "rad" : "m", [k](const JointFrame& j) { return j.coordinates[k].value; });
    add(what + " rate", angle ? "rad/s" : "m/s",
        [k](const JointFrame& j) { return j.coordinates[k].rate; });
  }
  add("force", "N", [](const JointFrame& j) { return j.mean_force.norm(); });
  add("torque", "N m", [](const JointFrame& j) { return j.mean_torque.norm(); });
}

/// A cell of a CSV file; names may have anything in them (RFC 4180).
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

}  // namespace

std::vector<Quantity> quantities_of(const Frame& frame, BodyId body) {
  std::vector<Quantity> out;
  const auto slot = find_slot(frame, body);
  if (!slot) return out;
  std::string name = frame.info(*slot).name;
  if (name.empty()) name = fmt::format("body {}", body.index);
  for (const OfBody& q : of_bodies)
    out.push_back({fmt::format("{}: {}", name, q.name), q.unit,
                   [body, value = q.value](F f) -> std::optional<double> {
                     const auto at = find_slot(f, body);
                     if (!at) return std::nullopt;
                     return value(f.body(*at), f.info(*at), f);
                   }});
  if (frame.joints)
    for (const JointFrame& joint : *frame.joints)
      if (joint.a == body || joint.b == body) add_joint(joint, out);
  return out;
}

std::vector<Quantity> quantities_of_sensors(const Frame& frame) {
  std::vector<Quantity> out;
  if (!frame.sensors) return out;
  for (const SensorFrame& sensor : *frame.sensors) {
    const size_t count = sensor_values(sensor).size();
    for (size_t k = 0; k < count; ++k) {
      const SensorValue value = sensor_values(sensor)[k];
      std::string words(value.name);
      std::ranges::replace(words, '_', ' ');
      out.push_back({fmt::format("{}: {}", sensor.name, words), std::string(value.unit),
                     [id = sensor.id, k](F f) -> std::optional<double> {
                       if (!f.sensors) return std::nullopt;
                       const auto at = std::ranges::find(*f.sensors, id, &SensorFrame::id);
                       if (at == f.sensors->end()) return std::nullopt;
                       return sensor_values(*at)[k].value;
                     }});
    }
  }
  return out;
}

std::optional<Quantity> quantity_of_name(const Frame& frame, const std::string& name) {
  const auto in = [&](std::vector<Quantity> list) -> std::optional<Quantity> {
    const auto found = std::ranges::find(list, name, &Quantity::name);
    return found == list.end() ? std::nullopt : std::optional(std::move(*found));
  };
  const std::string owner = name.substr(0, name.rfind(": "));
  for (size_t slot = 0; slot < frame.body_slots(); ++slot)
    if (!frame.body(slot).id.is_null() && frame.info(slot).name == owner)
      if (auto found = in(quantities_of(frame, frame.body(slot).id))) return found;
  if (frame.joints)
    for (const JointFrame& joint : *frame.joints)
      if (joint.name == owner)
        if (auto found = in(quantities_of(frame, joint.b.is_null() ? joint.a : joint.b)))
          return found;
  return in(quantities_of_sensors(frame));
}

void Measures::add(Quantity quantity, const Frame& now) {
  const bool there = std::ranges::any_of(
      series_, [&](const Series& s) { return s.quantity.name == quantity.name; });
  if (there || series_.size() >= most) return;
  Series& s = series_.emplace_back();
  s.quantity = std::move(quantity);
  if (const auto value = s.quantity.read(now)) {
    s.at.push_back(now.time);
    s.values.push_back(float(*value));
  }
}

void Measures::remove(size_t index) {
  if (index < series_.size()) series_.erase(series_.begin() + std::ptrdiff_t(index));
}

void Measures::see(const Frame& frame, bool ahead) {
  for (Series& s : series_) {
    auto place = std::ranges::lower_bound(s.at, frame.time) - s.at.begin();
    if (!ahead) {
      s.at.resize(size_t(place));
      s.values.resize(size_t(place));
    } else if (size_t(place) < s.at.size() && s.at[size_t(place)] == frame.time) {
      continue;  // already known
    }
    if (s.at.size() >= capacity) {  // drops a tenth at once, so that this is rare
      s.at.erase(s.at.begin(), s.at.begin() + capacity / 10);
      s.values.erase(s.values.begin(), s.values.begin() + capacity / 10);
      place = std::max<std::ptrdiff_t>(place - std::ptrdiff_t(capacity / 10), 0);
    }
    const auto value = s.quantity.read(frame);
    if (!value) continue;
    s.at.insert(s.at.begin() + place, frame.time);
    s.values.insert(s.values.begin() + place, float(*value));
  }
}

void Measures::want_past() {
  for (Series& s : series_) s.wants_past = true;
}

void Measures::forget_past() {
  for (Series& s : series_) s.wants_past = false;
}

void Measures::fill(const std::string& name, const std::vector<double>& at,
                    const std::vector<float>& values) {
  const auto found = std::ranges::find(
      series_, name, [](const Series& s) -> const std::string& { return s.quantity.name; });
  if (found == series_.end()) return;
  found->wants_past = false;
  std::map<double, float> all;
  for (size_t i = 0; i < std::min(at.size(), values.size()); ++i) all.emplace(at[i], values[i]);
  for (size_t i = 0; i < found->at.size(); ++i) all[found->at[i]] = found->values[i];
  while (all.size() > capacity) all.erase(all.begin());
  found->at.clear();
  found->values.clear();
  for (const auto& [time, value] : all) {
    found->at.push_back(time);
    found->values.push_back(value);
  }
}

void Measures::restart() {
  for (Series& s : series_) {
    s.at.clear();
    s.values.clear();
  }
}

std::string Measures::csv() const {
  std::map<double, std::vector<float>> rows;
  std::string out = "time [s]";
  for (size_t k = 0; k < series_.size(); ++k) {
    const Series& s = series_[k];
    out += "," + csv_cell(fmt::format("{} [{}]", s.quantity.name, s.quantity.unit));
    for (size_t i = 0; i < s.at.size(); ++i) {
      auto& row = rows[s.at[i]];
      row.resize(series_.size(), std::numeric_limits<float>::quiet_NaN());
      row[k] = s.values[i];
    }
  }
  out += '\n';
  for (const auto& [time, values] : rows) {
    out += fmt::format("{}", time);
    for (const float v : values) out += v == v ? fmt::format(",{}", v) : ",";
    out += '\n';
  }
  return out;
}

}  // namespace tumble
