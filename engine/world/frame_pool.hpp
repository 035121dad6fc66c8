#pragma once
#include "engine/core/recycler.hpp"
#include "engine/world/frame.hpp"

namespace tumble {

/// Memory of frames and of their parts, for reuse: a steady world makes its frames of those that
/// nobody holds any more.
struct FramePool {
  Recycler<Frame> frames;
  Recycler<Frame::BodyChunk> chunks;
  Recycler<std::vector<ContactFrame>> contacts;
  Recycler<std::vector<JointFrame>> joints;
  Recycler<ParticleFrame> particles;
  Recycler<std::vector<SensorFrame>> sensors;
  Recycler<Ledger> ledgers;
};

}  // namespace tumble
