#include "viewer/app/simulate/outputs.hpp"

#include "engine/scene/build.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/scenes/quantities.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Shortest text that reads back as the same double.
std::string numbers(std::initializer_list<double> values) {
  std::string out;
  for (const double v : values) out += fmt::format(",{}", v);
  return out;
}

std::string vector_columns(const Vec3& v) {
  return numbers({v.x(), v.y(), v.z()});
}

/// A name as a CSV field, quoted if necessary.
std::string field(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

std::string body_name(const Frame& frame, BodyId id) {
  if (id.is_null() || id.index >= frame.body_slots()) return "world";
  const std::string& name = frame.info(id.index).name;
  return name.empty() ? fmt::format("#{}", id.index) : field(name);
}

}  // namespace

EnergyCsv::EnergyCsv(const std::filesystem::path& file, std::shared_ptr<const BuiltScene> names)
    : file_(file), names_(std::move(names)) {
  for (const auto& [name, id] : names_->forces) force_names_.emplace_back(id, name);
  std::ranges::sort(force_names_);
}

void EnergyCsv::write_header(const Frame& frame) {
  header_ = true;
  const StepStats& stats = frame.stats;
  std::string line =
      std::string(
          "tick,time_s,kinetic_J,gravity_J,springs_J,fields_J,total_J,momentum_x,"
          "momentum_y,momentum_z,"
          "angular_momentum_x,angular_momentum_y,angular_momentum_z,bodies,awake,islands,"
          "bounds_tested,pairs_found,pairs,contacts,contact_points,max_penetration_m,"
          "events,impacts,fallbacks,time_stepped") +
      ledger_columns();
  if (frame.sensors)
    for (const SensorFrame& sensor : *frame.sensors) {
      sensors_.push_back(sensor.id);
      for (const SensorValue& v : sensor_values(sensor))
        line += fmt::format(",sensors.{}.{}", sensor.name, v.name);
    }
  if (frame.joints && frame.joints->size() <= most_joints)
    for (const JointFrame& joint : *frame.joints)
      if (names_->joints.contains(joint.name))
        for (std::string& name : joint_quantities(joint))
          line += "," + field(named_.emplace_back(std::move(name)));
  for (const auto& system : frame.particles)
    if (names_->particles.contains(system->name))
      for (const char* what : {"count", "speed", "temperature"})
        line +=
            "," + field(named_.emplace_back(fmt::format("particles.{}.{}", system->name, what)));
  for (const StageTime& stage : stats.stages) {
    stages_.emplace_back(stage.name);
    line += fmt::format(",{}_ms", field(stage.name));
  }
  file_.append(line + "\n");
}

std::string EnergyCsv::ledger_columns() const {
  std::string out;
  const auto line = [&out](std::string_view name) {
    out += fmt::format(",{}_work_J,{}_balance_J", name, name);
  };
  for (size_t i = 0; i < ledger_lines; ++i) line(ledger_line_name(LedgerLine(i)));
  for (const auto& [id, name] : force_names_) line("force_" + name);
  return out + ",energy_drift";
}

std::string EnergyCsv::ledger_values(const Ledger& ledger) const {
  std::string out;
  const auto entry = [&out](const LedgerEntry& e) { out += numbers({e.work, e.balance}); };
  for (size_t i = 0; i < ledger_lines; ++i) entry(ledger.line(LedgerLine(i)).total());
  for (const auto& [id, name] : force_names_) {
    const size_t slot = id.index;
    const bool there = slot < ledger.forces().size() && ledger.forces()[slot].id == id;
    entry(there ? ledger.forces()[slot].account.total() : LedgerEntry{});
  }
  return out + numbers({ledger.drift()});
}

void EnergyCsv::write_row(const Frame& frame) {
  const StepStats& s = frame.stats;
  const Energies& e = s.energies;
  std::string line = fmt::format("{},{}", frame.tick, frame.time);
  line += numbers({e.kinetic, e.gravity, e.springs, e.fields, e.total()});
  line += vector_columns(s.momentum) + vector_columns(s.angular_momentum);
  line += fmt::format(",{},{},{},{},{},{},{},{},{},{},{},{},{}", s.bodies, s.awake, s.islands,
                      s.bounds_tested, s.pairs_found, s.pairs, s.contacts, s.contact_points,
                      s.max_penetration, s.events, s.impacts, s.fallbacks, s.time_stepped);
  line += ledger_values(*frame.ledger);
  for (const SensorId id : sensors_) {
    // The sensors of a scene always exist while it is simulated.
    const auto sensor = std::ranges::find(*frame.sensors, id, &SensorFrame::id);
    for (const SensorValue& v : sensor_values(*sensor)) line += numbers({v.value});
  }
  // A coordinate that a broken joint no longer has is an empty cell.
  for (const std::string& name : named_) {
    const auto value = quantity(*names_, frame, name);
    line += value ? numbers({*value}) : ",";
  }
  for (const std::string& name : stages_) {
    double seconds = 0;
    for (const StageTime& stage : s.stages)
      if (stage.name == name) seconds += stage.seconds;
    line += fmt::format(",{:.4f}", 1e3 * seconds);
  }
  file_.append(line + "\n");
}

void EnergyCsv::add(const Frame& frame) {
  if (!file_.wanted()) return;
  // The initial state has no stage times: its row is written with the first step, which names the
  // stages.
  if (!header_ && !first_) {
    first_ = std::make_shared<Frame>(frame);
    return;
  }
  if (!header_) {
    write_header(frame);
    if (first_) write_row(*first_);
  }
  write_row(frame);
}

Status EnergyCsv::commit() {
  if (!header_ && first_) {
    write_header(*first_);
    write_row(*first_);
  }
  return file_.commit();
}

ContactCsv::ContactCsv(const std::filesystem::path& file) : file_(file) {
  file_.append(
      "tick,time_s,body_a,body_b,x,y,z,normal_x,normal_y,normal_z,gap_m,impulse_x,impulse_y,"
      "impulse_z,normal_force_N\n");
}

void ContactCsv::add(const Frame& frame) {
  if (!file_.wanted()) return;
  const double h = frame.rate.tick();
  frame.for_contacts([&](const ContactFrame& c) {
    file_.append(fmt::format("{},{},{},{}", frame.tick, frame.time, body_name(frame, c.a),
                             body_name(frame, c.b)) +
                 vector_columns(c.x_world) + vector_columns(c.normal) + numbers({c.gap}) +
                 vector_columns(c.impulse) + numbers({c.impulse.dot(c.normal) / h}) + "\n");
  });
}

namespace {

/// Value, rate and motor of each coordinate in the order of the kind's list, padded with empty
/// cells.
std::string coordinates_text(const JointFrame& joint) {
  std::string out;
  for (size_t k = 0; k < most_coordinates; ++k) {
    const CoordinateFrame& c = joint.coordinates[k];
    const bool there = k < entry_of(joint.kind).coordinates.size();
    out += there ? numbers({c.value, c.rate, c.motor}) : ",,,";
  }
  return out;
}

}  // namespace

JointCsv::JointCsv(const std::filesystem::path& file) : file_(file) {
  file_.append(
      "tick,time_s,joint,kind,body_a,body_b,x,y,z,force_x,force_y,force_z,torque_x,torque_y,"
      "torque_z,mean_force_x,mean_force_y,mean_force_z,mean_torque_x,mean_torque_y,"
      "mean_torque_z,value_1,rate_1,motor_1,value_2,rate_2,motor_2,value_3,rate_3,motor_3\n");
}

Status JointCsv::add(const World& world) {
  if (!file_.wanted()) return {};
  const auto reactions = world.joint_reactions();
  if (!reactions) return reactions.error();
  const auto frame = world.frame();
  for (size_t i = 0; i < reactions->size(); ++i) {
    const JointReaction& r = (*reactions)[i];
    const JointFrame& j = (*frame->joints)[i];
    file_.append(
        fmt::format("{},{},{},{},{},{}", frame->tick, frame->time,
                    j.name.empty() ? fmt::format("#{}", j.id.index) : field(j.name),
                    entry_of(j.kind).name, body_name(*frame, j.a), body_name(*frame, j.b)) +
        vector_columns(r.x_world) + vector_columns(r.force) + vector_columns(r.torque) +
        vector_columns(j.mean_force) + vector_columns(j.mean_torque) + coordinates_text(j) + "\n");
  }
  return {};
}

StageTrace::StageTrace(const std::filesystem::path& file) : file_(file) {
  file_.append("{\"displayTimeUnit\":\"ms\",\"traceEvents\":[");
}

void StageTrace::event(std::string_view name, double begin, double seconds, uint64_t tick) {
  if (!file_.wanted()) return;
  file_.append(fmt::format(
      "{}\n{{\"name\":\"{}\",\"ph\":\"X\",\"pid\":1,\"tid\":1,\"ts\":{:.3f},\"dur\":{:.3f},"
      "\"args\":{{\"tick\":{}}}}}",
      any_ ? "," : "", name, 1e6 * begin, 1e6 * seconds, tick));
  any_ = true;
}

void StageTrace::add(uint64_t tick, const StageTimes& stages, double begin, double seconds) {
  event("step", begin, seconds, tick);
  // Only the lengths of the stages are known; they run one after the other.
  double at = begin;
  for (const StageTime& stage : stages) {
    event(stage.name, at, stage.seconds, tick);
    at += stage.seconds;
  }
}

Status StageTrace::commit() {
  file_.append("\n]}\n");
  return file_.commit();
}

}  // namespace tumble
