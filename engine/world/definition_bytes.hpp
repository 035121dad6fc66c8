#pragma once
#include "engine/core/bytes.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/forces/force.hpp"
#include "engine/dynamics/particles/emitter.hpp"
#include "engine/dynamics/particles/particle_system.hpp"
#include "engine/dynamics/particles/sink.hpp"
#include "engine/world/settings.hpp"
#include "engine/world/shape_store.hpp"

namespace tumble {

// Definitions as bytes, for commands and snapshots. Readers call fail() on anything that is not
// valid; geometry is written as a content key and looked up in the store.
void write_body_def(ByteWriter& out, const BodyDef& def, ShapeStore& shapes);
BodyDef read_body_def(ByteReader& in, const ShapeStore& shapes);
void write_force_def(ByteWriter& out, const ForceDef& def);
ForceDef read_force_def(ByteReader& in);
void write_particles_def(ByteWriter& out, const ParticleSystemDef& def);
ParticleSystemDef read_particles_def(ByteReader& in);
/// Meshes are written as content keys.
void write_emitter_def(ByteWriter& out, const EmitterDef& def, ShapeStore& shapes);
EmitterDef read_emitter_def(ByteReader& in, const ShapeStore& shapes);
void write_sink_def(ByteWriter& out, const SinkDef& def);
SinkDef read_sink_def(ByteReader& in);
void write_settings(ByteWriter& out, const WorldSettings& settings);
WorldSettings read_settings(ByteReader& in);

}  // namespace tumble
