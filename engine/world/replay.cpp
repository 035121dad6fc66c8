#include "engine/world/replay.hpp"

#include "engine/world/shape_store.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <map>

namespace tumble {

Bytes save_replay(const World& world) {
  const ReplayLog& log = world.replay_log();
  ShapeStore shapes;
  std::map<uint64_t, std::shared_ptr<const TriangleMesh>> meshes;
  const auto add_mesh = [&](const std::shared_ptr<const TriangleMesh>& mesh) {
    if (mesh) meshes[shapes.add_mesh(mesh)] = mesh;
  };
  const auto add_body = [&](const BodyDef& def) {
    for (const BodyShapeDef& s : def.shapes) {
      add_mesh(s.shape.mesh);
      if (s.source) add_mesh(s.source->mesh);
    }
    for (const DrawnShapeDef& s : def.drawn) add_mesh(s.shape.mesh);
  };
  for (const LoggedCommand& c : log.entries()) {
    if (const auto* create = std::get_if<CreateBody>(&c.command)) add_body(create->def);
    if (const auto* set = std::get_if<SetBody>(&c.command)) add_body(set->def);
    const auto* create = std::get_if<CreateEmitter>(&c.command);
    const auto* set_emitter = std::get_if<SetEmitter>(&c.command);
    if (const EmitterDef* e = create ? &create->def : set_emitter ? &set_emitter->def : nullptr) {
      add_mesh(mesh_of(e->shape));
      if (e->body) add_body(*e->body);
    }
  }
  ByteWriter out;
  out.begin_section("replay", 1);
  out.value(world.tick());
  out.value(world.state_hash());
  out.end_section();
  out.begin_section("origin", 1);
  out.vector(log.origin());
  out.end_section();
  out.begin_section("meshes", 1);
  out.value(uint64_t(meshes.size()));
  for (const auto& [key, mesh] : meshes) write_mesh(out, *mesh);
  out.end_section();
  out.begin_section("commands", 1);
  out.value(uint64_t(log.entries().size()));
  for (const LoggedCommand& c : log.entries()) {
    out.value(c.tick);
    write_command(out, c.command, shapes);
  }
  out.end_section();
  return out.take();
}

Result<Replay> Replay::read(std::span<const std::byte> bytes) {
  const Error damaged{ErrorCode::parse, "this is no replay, or a damaged one", "replay",
                      "`tumble simulate --replay FILE` records one"};
  Replay out;
  ByteReader in(bytes);
  in.begin_section("replay");
  out.last_tick_ = in.get<uint64_t>();
  out.last_hash_ = in.get<uint64_t>();
  in.end_section();
  in.begin_section("origin");
  in.vector(out.origin_);
  in.end_section();
  out.shapes_ = std::make_shared<ShapeStore>();
  in.begin_section("meshes");
  const auto mesh_count = in.get<uint64_t>();
  for (uint64_t i = 0; i < mesh_count && in.ok(); ++i)
    out.shapes_->add_mesh(std::make_shared<const TriangleMesh>(read_mesh(in)));
  in.end_section();
  in.begin_section("commands");
  const auto count = in.get<uint64_t>();
  if (!in.ok()) return damaged;
  uint64_t before = 0;
  for (uint64_t i = 0; i < count; ++i) {
    const auto tick = in.get<uint64_t>();
    auto command = read_command(in, *out.shapes_);
    if (!command) return command.error();
    if (!in.ok() || tick < before || tick > out.last_tick_) return damaged;
    before = tick;
    out.commands_.push_back({tick, *std::move(command)});
  }
  return out;
}

Result<std::unique_ptr<World>> Replay::begin(WorldDef def) const {
  auto made = World::create(std::move(def), shapes_);
  if (!made) return made.error();
  if (Status s = (*made)->load(origin_); !s) return s.error();
  return made;
}

size_t Replay::count_before(uint64_t tick) const {
  const auto first = std::ranges::lower_bound(commands_, tick, {}, &LoggedCommand::tick);
  return size_t(first - commands_.begin());
}

/// Whether the commands in the world's log from `first` on equal the recorded ones.
bool Replay::same_commands(const World& world, size_t first) const {
  const std::vector<LoggedCommand>& done = world.replay_log().entries();
  if (done.size() > commands_.size()) return false;
  // Each side has a store of its own: geometry is compared by content.
  ShapeStore own, recorded;
  for (size_t i = first; i < done.size(); ++i) {
    if (done[i].tick != commands_[i].tick) return false;
    ByteWriter a, b;
    write_command(a, done[i].command, own);
    write_command(b, commands_[i].command, recorded);
    if (a.take() != b.take()) return false;
  }
  return true;
}

bool Replay::begins_as(const World& world) const {
  return world.replay_log().origin() == origin_ && same_commands(world, 0);
}

Result<Replay::Course> Replay::follow(World& world) const {
  const uint64_t now = world.tick();
  if (now > last_tick_) return Course::left;
  const size_t done = world.replay_log().entries().size(), earlier = count_before(now);
  // A different command at an earlier tick is in a place where the recording has another one, or
  // none.
  if (done < earlier || !same_commands(world, earlier)) return Course::left;
  for (size_t i = done; i < commands_.size() && commands_[i].tick == now; ++i)
    if (Status s = world.submit(commands_[i].command); !s) return s.error();
  if (Status s = world.apply_commands(); !s) return s.error();
  if (now < last_tick_) return Course::goes_on;
  return world.state_hash() == last_hash_ ? Course::ended_same : Course::ended_otherwise;
}

Result<Replayed> run_replay(std::span<const std::byte> replay, WorldDef def) {
  const auto read = Replay::read(replay);
  if (!read) return read.error();
  auto made = read->begin(std::move(def));
  if (!made) return made.error();
  while (true) {
    const auto course = read->follow(**made);
    if (!course) return course.error();
    if (*course != Replay::Course::goes_on)
      return Replayed{*std::move(made), *course == Replay::Course::ended_same};
    if (auto report = (*made)->step(); !report) return report.error();
  }
}

}  // namespace tumble
