#pragma once
#include "engine/core/recycler.hpp"
#include "engine/world/frame.hpp"

namespace tumble {

/// What frames are made of. A steady world makes them of those that nobody looks at any more.
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
