#include "engine/world/command.hpp"

#include "engine/world/definition_bytes.hpp"
#include "engine/world/joint_store.hpp"

namespace tumble {
namespace {

struct Write {
  ByteWriter& out;
  ShapeStore& shapes;

  void operator()(const CreateBody& c) {
    out.value(c.id);
    write_body_def(out, c.def, shapes);
  }
  void operator()(const DestroyBody& c) { out.value(c.id); }
  void operator()(const SetPose& c) {
    out.value(c.id);
    out.value(c.body_frame.x);
    out.value(c.body_frame.q.coeffs());
  }
  void operator()(const SetVelocity& c) {
    out.value(c.id);
    out.value(c.v);
    out.value(c.omega);
  }
  void operator()(const ApplyImpulse& c) {
    out.value(c.id);
    out.value(c.impulse);
    out.value(c.x_world);
  }
  void operator()(const CreateForce& c) {
    out.value(c.id);
    write_force_def(out, c.def);
  }
  void operator()(const SetForce& c) {
    out.value(c.id);
    write_force_def(out, c.def);
  }
  void operator()(const DestroyForce& c) { out.value(c.id); }
  void operator()(const CreateParticles& c) {
    out.value(c.id);
    write_particles_def(out, c.def);
  }
  void operator()(const DestroyParticles& c) { out.value(c.id); }
  void operator()(const SetSettings& c) { write_settings(out, c.settings); }
  void operator()(const CreateJoint& c) {
    out.value(c.id);
    write_joint_def(out, c.def);
  }
  void operator()(const SetJoint& c) {
    out.value(c.id);
    write_joint_def(out, c.def);
  }
  void operator()(const DestroyJoint& c) { out.value(c.id); }
  void operator()(const CreateEmitter& c) {
    out.value(c.id);
    write_emitter_def(out, c.def, shapes);
  }
  void operator()(const DestroyEmitter& c) { out.value(c.id); }
  void operator()(const CreateSink& c) {
    out.value(c.id);
    write_sink_def(out, c.def);
  }
  void operator()(const DestroySink& c) { out.value(c.id); }
  void operator()(const SetBody& c) {
    out.value(c.id);
    write_body_def(out, c.def, shapes);
  }
  void operator()(const CreateSensor& c) {
    out.value(c.id);
    write_sensor_def(out, c.def);
  }
  void operator()(const DestroySensor& c) { out.value(c.id); }
  void operator()(const SetParticles& c) {
    out.value(c.id);
    write_particles_def(out, c.def);
    out.value(uint8_t(c.keep));
  }
  void operator()(const SetEmitter& c) {
    out.value(c.id);
    write_emitter_def(out, c.def, shapes);
  }
};

struct Read {
  ByteReader& in;
  const ShapeStore& shapes;

  void operator()(CreateBody& c) {
    in.value(c.id);
    c.def = read_body_def(in, shapes);
  }
  void operator()(DestroyBody& c) { in.value(c.id); }
  void operator()(SetPose& c) {
    in.value(c.id);
    in.value(c.body_frame.x);
    in.value(c.body_frame.q.coeffs());
  }
  void operator()(SetVelocity& c) {
    in.value(c.id);
    in.value(c.v);
    in.value(c.omega);
  }
  void operator()(ApplyImpulse& c) {
    in.value(c.id);
    in.value(c.impulse);
    in.value(c.x_world);
  }
  void operator()(CreateForce& c) {
    in.value(c.id);
    c.def = read_force_def(in);
  }
  void operator()(SetForce& c) {
    in.value(c.id);
    c.def = read_force_def(in);
  }
  void operator()(DestroyForce& c) { in.value(c.id); }
  void operator()(CreateParticles& c) {
    in.value(c.id);
    c.def = read_particles_def(in);
  }
  void operator()(DestroyParticles& c) { in.value(c.id); }
  void operator()(SetSettings& c) { c.settings = read_settings(in); }
  void operator()(CreateJoint& c) {
    in.value(c.id);
    c.def = read_joint_def(in);
  }
  void operator()(SetJoint& c) {
    in.value(c.id);
    c.def = read_joint_def(in);
  }
  void operator()(DestroyJoint& c) { in.value(c.id); }
  void operator()(CreateEmitter& c) {
    in.value(c.id);
    c.def = read_emitter_def(in, shapes);
  }
  void operator()(DestroyEmitter& c) { in.value(c.id); }
  void operator()(CreateSink& c) {
    in.value(c.id);
    c.def = read_sink_def(in);
  }
  void operator()(DestroySink& c) { in.value(c.id); }
  void operator()(SetBody& c) {
    in.value(c.id);
    c.def = read_body_def(in, shapes);
  }
  void operator()(CreateSensor& c) {
    in.value(c.id);
    c.def = read_sensor_def(in);
  }
  void operator()(DestroySensor& c) { in.value(c.id); }
  void operator()(SetParticles& c) {
    in.value(c.id);
    c.def = read_particles_def(in);
    c.keep = in.get<uint8_t>() != 0;
  }
  void operator()(SetEmitter& c) {
    in.value(c.id);
    c.def = read_emitter_def(in, shapes);
  }
};

/// The alternative of this index, default-constructed.
template <size_t I = 0>
Command make_alternative(size_t index) {
  if constexpr (I + 1 < std::variant_size_v<Command>) {
    if (index != I) return make_alternative<I + 1>(index);
  }
  return std::variant_alternative_t<I, Command>{};
}

}  // namespace

void write_command(ByteWriter& out, const Command& command, ShapeStore& shapes) {
  out.value(uint8_t(command.index()));
  std::visit(Write{out, shapes}, command);
}

Result<Command> read_command(ByteReader& in, const ShapeStore& shapes) {
  const auto index = in.get<uint8_t>();
  if (index >= std::variant_size_v<Command>) in.fail();
  Command command = make_alternative(index);
  if (in.ok()) std::visit(Read{in, shapes}, command);
  if (!in.ok())
    return Error{
        ErrorCode::parse, "a command is damaged, or names geometry that is not there", {}, {}};
  return command;
}

ReplayLog::ReplayLog() = default;
ReplayLog::~ReplayLog() = default;
ReplayLog::ReplayLog(const ReplayLog&) = default;
ReplayLog::ReplayLog(ReplayLog&&) noexcept = default;
ReplayLog& ReplayLog::operator=(const ReplayLog&) = default;
ReplayLog& ReplayLog::operator=(ReplayLog&&) noexcept = default;

void ReplayLog::add(uint64_t tick, Command command) {
  entries_.push_back({tick, std::move(command)});
}

void ReplayLog::truncate(size_t count) {
  while (entries_.size() > count) entries_.pop_back();
}

void ReplayLog::restart(Bytes origin) {
  origin_ = std::move(origin);
  entries_.clear();
}

}  // namespace tumble
