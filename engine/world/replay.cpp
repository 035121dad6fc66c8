#include "engine/world/replay.hpp"

#include "engine/world/shape_store.hpp"

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

Result<Replayed> run_replay(std::span<const std::byte> replay, WorldDef def) {
  const Error damaged{ErrorCode::parse, "the replay log is damaged", "replay", {}};
  ByteReader in(replay);
  in.begin_section("replay");
  const auto last_tick = in.get<uint64_t>();
  const auto hash = in.get<uint64_t>();
  in.end_section();
  in.begin_section("origin");
  Bytes origin;
  in.vector(origin);
  in.end_section();
  auto shapes = std::make_shared<ShapeStore>();
  in.begin_section("meshes");
  const auto mesh_count = in.get<uint64_t>();
  for (uint64_t i = 0; i < mesh_count && in.ok(); ++i)
    shapes->add_mesh(std::make_shared<const TriangleMesh>(read_mesh(in)));
  in.end_section();
  in.begin_section("commands");
  const auto count = in.get<uint64_t>();
  if (!in.ok()) return damaged;

  auto made = World::create(std::move(def), shapes);
  if (!made) return made.error();
  World& world = **made;
  if (Status s = world.load(origin); !s) return s.error();
  for (uint64_t i = 0; i < count; ++i) {
    const auto tick = in.get<uint64_t>();
    auto command = read_command(in, *shapes);
    if (!command) return command.error();
    if (tick < world.tick() || tick > last_tick) return damaged;
    while (world.tick() < tick)
      if (auto report = world.step(); !report) return report.error();
    if (Status s = world.submit(std::move(*command)); !s) return s.error();
  }
  if (Status s = world.apply_commands(); !s) return s.error();
  while (world.tick() < last_tick)
    if (auto report = world.step(); !report) return report.error();
  const bool same = world.state_hash() == hash;
  return Replayed{std::move(*made), same};
}

}  // namespace tumble
