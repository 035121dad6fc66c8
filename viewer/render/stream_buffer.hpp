#pragma once
#include "viewer/render/device.hpp"

namespace tumble {

/// A buffer that is refilled every frame.
class StreamBuffer {
 public:
  StreamBuffer(Device& device, BufferUse use)
      : device_(device), id_(device.create_buffer(use, 0, {})) {}
  ~StreamBuffer() { device_.destroy(id_); }
  StreamBuffer(const StreamBuffer&) = delete;
  StreamBuffer& operator=(const StreamBuffer&) = delete;
  void fill(std::span<const std::byte> data) { device_.update_buffer(id_, data); }
  BufferId id() const { return id_; }

 private:
  Device& device_;
  BufferId id_;
};

}  // namespace tumble
